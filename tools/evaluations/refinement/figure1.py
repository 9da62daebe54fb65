"""The paper's Figure 1: greedy and refined paths from the same starts, and the transition between actions.

Greedy reaches the ball sooner and then turns around with it; refined arrives later and continues straight on.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.tools.cli.number_checks import add_count
from tailor.tools.cli.output_files import whole_output
from tailor.tools.evaluations.outcome import Task, Variant
from tailor.tools.evaluations.pages.report import Report, configure_report, publish_report
from tailor.tools.evaluations.paired_comparison import compare
from tailor.tools.evaluations.seeds import seeds_of
from tailor.tools.evaluations.traced_runs import TracedRun, trace_all
from tailor.tools.figures.paths import draw_paths
from tailor.tools.figures.track import Track

MODES = (("greedy", 1), ("refined", 2))  # the paper's h
SLOW_MPS = 0.1  # below it the robot stands or turns on the spot
Found = Mapping[tuple[str, int], TracedRun]


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate figure1`."""
    add_count(parser, "--episodes", 2, 60, "starts")
    add_count(parser, "--drawn", 0, 3, "number of starts to draw")
    configure_report(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run, draw and publish the report; 0 if refined runs are faster in the mean."""
    seeds = seeds_of("soccer", arguments)
    starts = seeds.starts(arguments.episodes)
    drawn = starts[: arguments.drawn]
    task = Task("soccer", "approach-dribble", "", arguments.zoo)
    variants = [Variant(name, replace(RefinementSettings(), horizon=h)) for name, h in MODES]
    found = trace_all(task, variants, starts, arguments.jobs, "figure 1")
    rows = [_row(name, horizon, found, starts) for name, horizon in MODES]
    rows += [_example(name, horizon, found[name, s]) for s in drawn for name, horizon in MODES]
    plots = {} if arguments.report is None else _draw(found, drawn, arguments.report)
    remarks = [
        f"Drawn: the first {arguments.drawn} starts of the evaluation, not selected. Lines stand across the robot's "
        "heading, ten a second; their length is its speed. Disc: ball at the start; circle: at the end; + subgoal that "
        "with a free parameter; * target.",
        f"slow_s: time at less than {SLOW_MPS} m/s between the first and the last action",
    ]
    report = Report("figure1", "Figure 1: greedy and refined", rows, remarks, plots, seeds.provenance)
    publish_report(report, arguments)
    return 0 if rows[1]["improvement_pct"] > 0 else 1


def _row(name: str, horizon: int, found: Found, seeds: Sequence[int]) -> dict[str, Any]:
    """Means over the starts from which both reached the goal."""
    both = [seed for seed in seeds if all(found[mode, seed].outcome.achieved for mode, _ in MODES)]
    greedy_s, these_s = ([found[mode, seed].outcome.duration_s for seed in both] for mode in ("greedy", name))
    return {
        "run": name,
        "horizon": horizon,
        "n": len(both),
        "duration_s": float(np.mean(these_s)),
        "improvement_pct": compare(greedy_s, these_s).improvement_pct if len(both) > 1 else float("nan"),
        **{
            key: float(np.nanmean([measure(found[name, seed].track) for seed in both]))
            for key, measure in MEASURES.items()
        },
    }


def _example(name: str, horizon: int, watched: TracedRun) -> dict[str, Any]:
    outcome = watched.outcome
    figures = {key: measure(watched.track) for key, measure in MEASURES.items()}
    predicted = {"predicted_s": sum(outcome.predicted_s)}
    run = {"run": f"{name}, {outcome.seed}", "horizon": horizon, "n": 1, "duration_s": outcome.duration_s}
    return {**run, **figures, **predicted}


def until_ball_s(track: Track) -> float:
    """Seconds of all actions before the last dribble; NaN without a dribble."""
    names = [action.action for action in track.finished]
    if "dribbleBall" not in names:
        return float("nan")
    last = len(names) - 1 - names[::-1].index("dribbleBall")
    return sum(action.actual_s for action in track.finished[:last])


def dribble_s(track: Track) -> float:
    """Seconds of the last dribble; NaN without one."""
    return next((action.actual_s for action in track.finished[::-1] if action.action == "dribbleBall"), float("nan"))


def path_m(track: Track) -> float:
    """Length of the robot's path."""
    places = np.array([(point.x, point.y) for point in track.points]).reshape(-1, 2)
    return float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())


def slow_s(track: Track) -> float:
    """Seconds between first and last action at less than SLOW_MPS."""
    times = np.array([point.time_s for point in track.points])
    speeds = np.array([abs(point.v) for point in track.points])
    return float(np.sum(np.diff(times)[speeds[1:] < SLOW_MPS])) if len(times) > 1 else 0.0


def handover_mps(track: Track) -> float:
    """Speed at the start of the dribble; NaN without one."""
    speeds = [abs(point.v) for point in track.points if point.name == "dribbleBall"]
    return speeds[0] if speeds else float("nan")


MEASURES: Mapping[str, Callable[[Track], float]] = {
    "until_ball_s": until_ball_s,
    "dribble_s": dribble_s,
    "path_m": path_m,
    "slow_s": slow_s,
    "speed_at_ball_mps": handover_mps,
}


def _draw(found: Found, seeds: Sequence[int], folder: Path) -> dict[str, Path]:
    plots = {}
    for seed in seeds:
        path = folder / f"figure1-{seed}.png"
        tracks = [replace(found[name, seed].track, title=f"{name} (h = {horizon})") for name, horizon in MODES]
        with whole_output(path) as whole:
            draw_paths(tracks, whole)
        plots[f"paths, greedy and refined, start {seed}"] = path
    return plots
