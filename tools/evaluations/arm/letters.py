"""The arm's letters: refined against stopping at each waypoint, learned greedy and perfect greedy."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tailor.executive.domains.arm.letters import font
from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import add_count
from tailor.tools.evaluations.arm.letter_figures import (
    LEARNED,
    LEARNED_GREEDY,
    ORACLES,
    PERFECT_GREEDY,
    REFINED,
    STOPPING,
    Figures,
    Found,
    Key,
    measure_letters,
    write_letter,
)
from tailor.tools.evaluations.costs import Costs
from tailor.tools.evaluations.pages.report import Report, configure_report, publish_report
from tailor.tools.evaluations.paired_comparison import Comparison, compare, compare_means
from tailor.tools.evaluations.seeds import Seeds, seeds_of
from tailor.tools.figures.letters import draw_letters

DOMAINS = ("arm",)
PAPER = "paper: 4-5 actions, n = 4: 10.6 s greedy, 10.0 s refined, 5.7 %, p = 0.08"
REMARKS = (
    "each mode against stopping at each waypoint, against greedy by the learned model and against greedy by the "
    "simulator's own outcome; 95 % interval: over letters, the mean of a letter's seeds counts once; energy and "
    "arrival with the difference to learned greedy",
    "an oracle chooses by the controller's own rule; all ahead is the ceiling",
)
SHOWN = "FTAS"  # in the picture


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate letters`."""
    add_count(parser, "--seeds", 1, 3, "starts and sizes of each letter")
    parser.add_argument("--letters", default="", help="only these, e.g. BDF, from the same starts (default: all)")
    parser.add_argument("--no-oracle", action="store_true", help="leave out what chooses by the controller's own rule")
    configure_report(parser)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; 0 if refined letters are faster than all others that were written.

    Raises:
      UsageError: A letter that the font lacks, the same one twice, or only one.
    """
    seeds, known, chosen = seeds_of("arm", arguments), sorted(font()), arguments.letters
    if len(set(chosen)) < len(chosen) or not set(chosen) <= set(known):
        raise UsageError(f"--letters is '{chosen}', expected some of {''.join(known)}, each once")
    if len(chosen) == 1:
        raise UsageError(f"--letters is '{chosen}', expected at least two letters: intervals are over them")
    modes = (*LEARNED, PERFECT_GREEDY, *(() if arguments.no_oracle else ORACLES))
    keys = [key for key in keys_of(seeds, arguments.seeds) if key[0] in (chosen or known)]
    found = measure_letters(modes, keys, arguments.zoo, arguments.jobs)
    rows = rows_of(found)
    plots = {} if arguments.report is None else _picture(arguments.report, seeds.first, arguments.zoo)
    report = Report("letters", "Letters by the arm", rows, (PAPER, *REMARKS), plots, seeds.provenance)
    publish_report(report, arguments)
    return 0 if is_fastest(next(row for row in rows if row["mode"] == REFINED.name)) else 1


def keys_of(seeds: Seeds, each: int) -> list[Key]:
    """Letters with starts of their own: a start decides on the temperature; one for all letters would be one unit."""
    letters = sorted(font())
    return [(letters[k % len(letters)], seed) for k, seed in enumerate(seeds.starts(each * len(letters)))]


def is_fastest(row: dict[str, Any]) -> bool:
    """Whether the letters of a row are faster than those of each mode that it is compared with (95 %)."""
    compared = ["ci95", *(name for name in row if name.startswith("against_") and name.endswith("_ci95"))]
    return all(row[name][0] > 0 for name in compared)


def rows_of(found: Found) -> list[dict[str, Any]]:
    """One row for each mode, over the letters that every mode finished."""
    keys = [key for key in found[REFINED.name] if all(figures[key].achieved for figures in found.values())]
    rows = [_row(name, found, keys) for name in found]
    if ORACLES[-1].name in found:
        _add_share(rows)
    return rows


def _row(name: str, found: Found, keys: Sequence[Key]) -> dict[str, Any]:
    mine = [found[name][key] for key in keys]
    greedy = _against(LEARNED_GREEDY.name, name, found, keys)
    row: dict[str, Any] = {
        "mode": name,
        "n": greedy.n,
        "letters": greedy.units,
        "failed": sum(not figures.achieved for figures in found[name].values()),
        "mean_s": greedy.mean_s,
        **greedy.verdict,
    }
    for mode in (STOPPING, PERFECT_GREEDY):
        if mode.name in found:
            column, other = f"against_{mode.name.replace(' ', '_')}", _against(mode.name, name, found, keys)
            row |= {f"{column}_pct": other.improvement_pct, f"{column}_ci95": other.ci95}
    row |= _costs(name, found, keys)
    measured = ("waypoint_mrad", "peak_current_a", "rms_jerk", "roughness", "bias_s")
    return row | {field: _mean(mine, field) for field in measured}


def _costs(name: str, found: Found, keys: Sequence[Key]) -> dict[str, Any]:
    """Energy and errors of arrival, and how much more they are than of learned greedy; letters are units."""
    greedy, mine = ([found[mode][key].costs for key in keys] for mode in (LEARNED_GREEDY.name, name))
    letters, columns = [letter for letter, _ in keys], dict[str, Any]()
    for cost in ("energy_j", *sorted({each for costs in mine for each, _ in costs.arrival})):
        first, second = ([_cost(costs, cost) for costs in some] for some in (greedy, mine))
        if np.isfinite([*first, *second]).all():
            column = cost if cost == "energy_j" else f"arrival_{cost}"
            columns[column] = float(np.mean(second))
            if first != second:
                columns[f"{column}_more_ci95"] = compare_means(first, second, letters).ci95
    return columns


def _cost(costs: Costs, name: str) -> float:
    return costs.energy_j if name == "energy_j" else dict(costs.arrival).get(name, float("nan"))


def _against(baseline: str, name: str, found: Found, keys: Sequence[Key]) -> Comparison:
    """Compare two modes with letters as units."""
    first, second = ([found[mode][key].duration_s for key in keys] for mode in (baseline, name))
    return compare(first, second, [letter for letter, _ in keys])


def _add_share(rows: Sequence[dict[str, Any]]) -> None:
    """How much of what could be gained over the model's greedy choice is gained, by mean durations; nan: nothing."""
    mean = {row["mode"]: row["mean_s"] for row in rows}
    ceiling_s = min(mean[ORACLES[-1].name], mean[ORACLES[1].name])
    most_s = mean["greedy"] - ceiling_s
    for row in rows:
        row["share_of_gain_pct"] = 100 * (mean["greedy"] - row["mean_s"]) / most_s if most_s else float("nan")


def _mean(some: Sequence[Figures], field: str) -> float:
    return float(np.mean([getattr(figures, field) for figures in some]))


def _picture(folder: Path, seed: int, zoo: str) -> dict[str, Path]:
    path = folder / "letters.png"
    draw_letters([[write_letter(mode, letter, seed, zoo) for letter in SHOWN] for mode in LEARNED], path)
    return {"letters as in Figure 13 (b), joint space": path}
