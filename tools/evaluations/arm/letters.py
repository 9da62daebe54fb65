"""The arm's row of Table 3: every letter in several modes from equal starts, and the gain of a perfect model."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from joblib import Parallel, delayed
from rich.progress import track

from tailor.executive.domains.arm.letters import font
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.models.runtime import load_robot
from tailor.tools.cli.number_checks import at_least
from tailor.tools.evaluations.arm.perfect_reach import PerfectReach
from tailor.tools.evaluations.outcome import FIRST_SEED
from tailor.tools.evaluations.paired_comparison import compare
from tailor.tools.evaluations.report import Report, configure_report, publish_report
from tailor.tools.figures.letters import draw_letters
from tailor.tools.writing.measures import rms_jerk, roughness, waypoint_errors_rad
from tailor.tools.writing.writing_run import RecordedBody, WritingMode, write
from tailor.tools.writing.writing_track import WritingTrack

DOMAINS = ("arm",)
ALL_AHEAD = 9  # more actions than a letter has
BASE = RefinementSettings()
GREEDY = replace(BASE, horizon=1)
HANDS = (WritingMode("stopping", BASE, stops=True), WritingMode("greedy", GREEDY), WritingMode("refined", BASE))
ORACLES = (
    WritingMode("oracle, greedy", GREEDY),
    WritingMode("oracle, refined", BASE),
    WritingMode("oracle, all ahead", replace(BASE, horizon=ALL_AHEAD)),
)
PAPER = "paper: 4-5 actions, n = 4: 10.6 s greedy, 10.0 s refined, 5.7 %, p = 0.08"
SHOWN = "FTAS"  # in the picture
Key = tuple[str, int]  # letter, seed


@dataclass(frozen=True, slots=True)
class Figures:
    """Figures of one letter in one mode."""

    achieved: bool
    duration_s: float
    waypoint_mrad: float  # the largest of the letter
    peak_current_a: float
    rms_jerk: float
    roughness: float
    bias_s: float  # predicted minus actual, a reach


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate letters`."""
    parser.add_argument(
        "--seeds", type=at_least(1, "--seeds"), default=5, help="starts and sizes of each letter (default %(default)s)"
    )
    parser.add_argument("--no-oracle", action="store_true", help="leave the perfect model out")
    configure_report(parser)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; 0 if refinement gains significantly."""
    rows, plots = evaluate(arguments)
    remarks = [PAPER, "an oracle chooses by the controller's own duration instead of a learned model"]
    publish_report(Report("letters", "Table 3, arm: letters", rows, remarks, plots), arguments.json, arguments.report)
    refined = next(row for row in rows if row["mode"] == "refined")
    return 0 if refined["p_value"] < 0.01 and refined["improvement_pct"] > 0 else 1


Found = Mapping[str, Mapping[Key, Figures]]  # by hand


def evaluate(arguments: argparse.Namespace) -> tuple[list[dict[str, Any]], dict[str, Path]]:
    """One row for each mode, and the picture if a report is requested."""
    found = _write_all(arguments)
    rows = _rows(found)
    return rows, {} if arguments.report is None else _picture(arguments.report, arguments.zoo)


def _write_all(arguments: argparse.Namespace) -> Found:
    """Every letter at every seed in every mode."""
    hands = HANDS if arguments.no_oracle else (*HANDS, *ORACLES)
    keys = [(letter, FIRST_SEED + k) for k in range(arguments.seeds) for letter in sorted(font())]
    wanted = [(hand, key) for key in keys for hand in hands]
    done = Parallel(n_jobs=arguments.jobs, return_as="generator")(
        delayed(_measured)(hand, key, arguments.zoo) for hand, key in wanted
    )
    found: dict[str, dict[Key, Figures]] = {hand.name: {} for hand in hands}
    for (hand, key), figures in zip(wanted, track(done, "letters", total=len(wanted), transient=True), strict=True):
        found[hand.name][key] = figures
    return found


def _rows(found: Found) -> list[dict[str, Any]]:
    rows = [_row(name, found) for name in found]
    if ORACLES[-1].name in found:
        _add_share(rows)
    return rows


def _both_achieved(name: str, found: Found) -> list[Key]:
    return [key for key, figures in found[name].items() if figures.achieved and found["greedy"][key].achieved]


def _row(name: str, found: Found) -> dict[str, Any]:
    """One mode against the greedy one, over the letters that both finished."""
    keys = _both_achieved(name, found)
    mine, greedy = [found[name][key] for key in keys], [found["greedy"][key] for key in keys]
    comparison = compare([figures.duration_s for figures in greedy], [figures.duration_s for figures in mine])
    stopping = [found["stopping"][key].duration_s for key in keys]
    return {
        "mode": name,
        "n": comparison.n,
        "failed": len(found[name]) - sum(figures.achieved for figures in found[name].values()),
        "mean_s": comparison.mean_s,
        **comparison.verdict,
        "against_stopping_pct": compare(stopping, [figures.duration_s for figures in mine]).improvement_pct,
        "waypoint_mrad": _mean(mine, "waypoint_mrad"),
        "peak_current_a": _mean(mine, "peak_current_a"),
        "rms_jerk": _mean(mine, "rms_jerk"),
        "roughness": _mean(mine, "roughness"),
        "bias_s": _mean(mine, "bias_s"),
    }


def _add_share(rows: Sequence[dict[str, Any]]) -> None:
    """How much of what could be gained over the model's greedy choice is gained, by mean durations."""
    mean = {row["mode"]: row["mean_s"] for row in rows}
    ceiling_s = min(mean["oracle, all ahead"], mean["oracle, refined"])
    for row in rows:
        row["share_of_gain_pct"] = 100 * (mean["greedy"] - row["mean_s"]) / (mean["greedy"] - ceiling_s)


def _mean(some: Sequence[Figures], field: str) -> float:
    return float(np.mean([getattr(figures, field) for figures in some]))


def _measured(hand: WritingMode, key: Key, zoo: str) -> Figures:
    track = _write(hand, *key, zoo)
    actual_s = np.diff(track.arrivals_s, prepend=0.0)
    return Figures(
        track.result == "achieved",
        track.duration_s,
        1e3 * float(waypoint_errors_rad(track).max()),
        track.peak_current_a,
        rms_jerk(track),
        roughness(track),
        float((track.predicted_s - actual_s).mean() + 0.1),  # an action ends one period before its waypoint
    )


def _write(hand: WritingMode, letter: str, seed: int, zoo: str) -> WritingTrack:
    models = Models({"reach/duration": PerfectReach()}, {}) if hand in ORACLES else _models(zoo)
    return write(letter, hand, models, seed, RecordedBody())


@lru_cache(maxsize=2)
def _models(zoo: str) -> Models:
    """Loaded once a process."""
    return Models(*load_robot(RecordedBody.robot, Path(zoo) if zoo else None))


def _picture(folder: Path, zoo: str) -> dict[str, Path]:
    path = folder / "letters.png"
    draw_letters([[_write(hand, letter, FIRST_SEED, zoo) for letter in SHOWN] for hand in HANDS], path)
    return {"letters as in Figure 13 (b), joint space": path}
