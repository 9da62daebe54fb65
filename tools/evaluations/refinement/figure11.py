"""The paper's Figure 11: predicted durations over the free angle of approach, and what the same sweep takes simulated.

Every angle is forced in turn. The executive predicts both actions, asserted subgoals included, then executes them.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import add_count
from tailor.tools.evaluations.outcome import OTHER_NOISE, Outcome, Task, Variant
from tailor.tools.evaluations.pages.report import Report, configure_report, publish_report
from tailor.tools.evaluations.refinement.sweep import Sweep, sweep_of
from tailor.tools.evaluations.refinement.sweep_plot import draw_sweep
from tailor.tools.evaluations.seeds import seeds_of
from tailor.tools.evaluations.task_runs import run_all
from tailor.tools.evaluations.traced_runs import trace_run

PLACE = "pos2"  # where the ball is
TASK = ("soccer", "approach-dribble")
REMARKS = (
    "angles: how many of the forced ones have a run that ended well; the last row is the mean over the starts",
    "angle: the robot's heading at the ball in the field's frame, the free angle of approach; its speed there is free "
    "too, and as refinement chose it",
    "regret: how much longer the simulated episode takes at the model's best angle than at the best angle of all "
    "(the best of many noisy runs: a perfect model has a little regret, too)",
    "ring: the executive asserts a subgoal before the approach, which is part of that action's time",
)


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate figure11`."""
    add_count(parser, "--episodes", 2, 10, "starts at which to sweep")
    add_count(parser, "--drawn", 0, 2, "number of starts to draw")
    add_count(parser, "--points", 2, 36, "angles")
    add_count(parser, "--repeats", 1, 3, "runs of each angle, with different noise")
    configure_report(parser)


def run(arguments: argparse.Namespace) -> int:
    """Sweep, draw and publish the report; 0 if the model's best angle is faster than greedy's in simulation."""
    task = Task(*TASK, "", arguments.zoo)
    seeds = seeds_of(task.domain, arguments)
    starts = seeds.starts(arguments.episodes)
    sweeps = [sweep for seed in starts if (sweep := _swept(task, seed, arguments)) is not None]
    if not sweeps:
        raise UsageError(f"--episodes {arguments.episodes}: no start had a free angle and ended well, expected more")
    rows = [_row(sweep) for sweep in sweeps]
    rows.append(_mean(rows))
    plots = {}
    if arguments.report is not None:
        for sweep in sweeps[: arguments.drawn]:
            path = arguments.report / f"figure11-{sweep.seed}.png"
            plots[f"predicted and simulated durations, start {sweep.seed}"] = _draw(task, sweep, path)
    title = "Figure 11: durations over the angle of approach"
    publish_report(Report("figure11", title, rows, REMARKS, plots, seeds.provenance), arguments)
    return 0 if rows[-1]["simulated_at_model_best_s"] < rows[-1]["simulated_at_greedy_s"] else 1


def _swept(task: Task, seed: int, arguments: argparse.Namespace) -> Sweep | None:
    """The sweep at one start; None where the angle was not free (the ball was there already) or nothing succeeded."""
    base = RefinementSettings()
    free = [Variant(name, replace(base, horizon=h)) for name, h in (("greedy", 1), ("refined", 2))]
    outcomes = run_all(task, free, [seed], 1, arguments.store, f"figure 11, start {seed}")
    greedy, refined = outcomes["greedy"][seed], outcomes["refined"][seed]
    chosen = {quantity: value for label, quantity, *_, value in refined.free if label == PLACE}
    if "phi" not in chosen or "v" not in chosen:
        return None
    angles = np.linspace(-math.pi, math.pi, arguments.points, endpoint=False)
    variants = [_pinned(phi, chosen["v"], k) for phi in angles.tolist() for k in range(arguments.repeats)]
    store = arguments.store / "figure11"  # apart, because every angle has a file of its own
    found = run_all(task, variants, [seed], arguments.jobs, store, f"figure 11, start {seed}")
    runs = [found[variant.name][seed] for variant in variants]
    by_angle = [runs[i : i + arguments.repeats] for i in range(0, len(runs), arguments.repeats)]
    return sweep_of(seed, angles, chosen["v"], by_angle, _angle(greedy), chosen["phi"])


def _pinned(phi: float, v: float, noise: int) -> Variant:
    name = f"phi={phi:.4f}-v={v:.4f}-{noise}"
    return Variant(name, RefinementSettings(), ((PLACE, "phi", phi), (PLACE, "v", v)), noise * OTHER_NOISE)


def _angle(outcome: Outcome) -> float:
    return next(value for label, quantity, *_, value in outcome.free if (label, quantity) == (PLACE, "phi"))


def _row(sweep: Sweep) -> dict[str, Any]:
    model, simulated = sweep.model_best, sweep.simulated_best
    return {
        "start": str(sweep.seed),
        "angles": int(np.isfinite(sweep.simulated_s[2]).sum()),
        "model_best_deg": math.degrees(sweep.angles[model]),
        "simulated_best_deg": math.degrees(sweep.angles[simulated]),
        "refined_deg": math.degrees(sweep.refined_rad),
        "greedy_deg": math.degrees(sweep.greedy_rad),
        "predicted_min_s": float(sweep.predicted_s[2, model]),
        "simulated_at_model_best_s": float(sweep.simulated_s[2, model]),
        "simulated_at_refined_s": sweep.simulated_at(sweep.refined_rad),
        "simulated_at_greedy_s": sweep.simulated_at(sweep.greedy_rad),
        "simulated_min_s": float(sweep.simulated_s[2, simulated]),
        "regret_pct": 100 * float(sweep.simulated_s[2, model] / sweep.simulated_s[2, simulated] - 1),
        "mae_s": float(np.nanmean(np.abs(sweep.predicted_s[2] - sweep.simulated_s[2]))),
        **dict(zip(("bias_approach_s", "bias_dribble_s", "bias_s"), sweep.bias_s, strict=True)),
        "correlation": sweep.correlation,
        "asserted_pct": 100 * float(np.mean(sweep.asserted)),
    }


def _mean(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """The mean over the starts, whose number it names; directions have none."""
    kept = [key for key in rows[0] if not key.endswith("_deg") and key != "start"]
    return {"start": f"mean of {len(rows)}"} | {key: float(np.nanmean([row[key] for row in rows])) for key in kept}


def _draw(task: Task, sweep: Sweep, path: Path) -> Path:
    """The polar plots, and below them the runs at three of the angles."""
    choices = (
        ("greedy", sweep.greedy_rad),
        ("model's best", float(sweep.angles[sweep.model_best])),
        ("simulation's best", float(sweep.angles[sweep.simulated_best])),
    )
    tracks = []
    for title, phi in choices:
        track = trace_run(task, _pinned(phi, sweep.v, 0), sweep.seed)[0].track
        tracks.append(replace(track, title=f"{title}, {math.degrees(phi):.0f}°"))
    draw_sweep(sweep, tracks, path)
    return path
