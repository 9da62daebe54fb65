"""The paper's Figure 11: polar plots of durations over the angle of approach, and below them runs at some angles."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from tailor.executive.interfaces.values import Array
from tailor.tools.evaluations.pages.plots import saved
from tailor.tools.evaluations.refinement.sweep import Sweep
from tailor.tools.figures.paths import draw_side_by_side, size_in
from tailor.tools.figures.signed_degrees import count_both_ways
from tailor.tools.figures.track import Track

MODEL, SIMULATED, BAND = "#1f77b4", "#2c3e50", "#b8c4cc"
TITLES = ("approachBall, with asserted subgoals", "dribbleBall", "sum")


def draw_sweep(sweep: Sweep, tracks: Sequence[Track], path: Path) -> None:
    """Draw into a PNG.

    Args:
      sweep: What was predicted, and what was simulated.
      tracks: Runs at three angles of it.
      path: Where to; its folder is made.
    """
    saved(figure_of(sweep, tracks), path)


def figure_of(sweep: Sweep, tracks: Sequence[Track]) -> Figure:
    """The polar plots above the runs, each of which has room for its legend."""
    figure = Figure(figsize=(size_in(tracks)[0], 9.6), layout="constrained")
    parts: Any = figure.subfigures(2, 1, height_ratios=(1.1, 1))
    top, bottom = parts
    polar = top.subplots(1, 3, subplot_kw={"projection": "polar"})
    for number, axis in enumerate(polar):
        _draw(axis, sweep, number)
        axis.set_title(TITLES[number], fontsize="medium")
    top.legend(*polar[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize="small")
    top.suptitle(f"seconds over the heading at the ball; speed there {sweep.v:.2f} m/s; start {sweep.seed}")
    draw_side_by_side(bottom.subplots(1, len(tracks)), tracks)
    return figure


def _draw(axis: Any, sweep: Sweep, number: int) -> None:
    """One polar plot, with both minima of it."""
    _draw_curves(axis, sweep, number)
    _draw_minima(axis, sweep, number)
    count_both_ways(axis)
    axis.set_rlabel_position(112)
    axis.yaxis.set_major_formatter("{x:g} s")
    axis.tick_params(labelsize="small")


def _draw_curves(axis: Any, sweep: Sweep, number: int) -> None:
    """Predicted and simulated seconds, with the range of the runs and the angles with an asserted subgoal."""
    angles = np.append(sweep.angles, sweep.angles[0] + 2 * np.pi)
    predicted = sweep.predicted_s[number]
    axis.fill_between(
        angles,
        _round(sweep.least_s[number]),
        _round(sweep.most_s[number]),
        color=BAND,
        alpha=0.6,
        label="least to most of its runs",
    )
    axis.plot(angles, _round(sweep.simulated_s[number]), color=SIMULATED, linewidth=1.6, label="simulated")
    axis.plot(angles, _round(predicted), color=MODEL, linewidth=2.2, label="predicted by the models")
    axis.plot(
        sweep.angles[sweep.asserted],
        predicted[sweep.asserted],
        "o",
        markerfacecolor="none",
        color=MODEL,
        markersize=5,
        label="with an asserted subgoal",
    )


def _draw_minima(axis: Any, sweep: Sweep, number: int) -> None:
    """A line and a star at the least of both curves, and what they are in words."""
    predicted, simulated = sweep.predicted_s[number], sweep.simulated_s[number]
    top = 1.05 * float(np.nanmax([predicted, simulated]))
    lines = []
    for name, seconds, colour in (("predicted", predicted, MODEL), ("simulated", simulated, SIMULATED)):
        best = int(np.nanargmin(seconds))
        axis.plot([sweep.angles[best]] * 2, [0, top], color=colour, linestyle="--", linewidth=1.2)
        axis.plot([sweep.angles[best]], [seconds[best]], "*", color=colour, markersize=13, markeredgecolor="white")
        lines.append(f"least {name}: {seconds[best]:.1f} s at {np.degrees(sweep.angles[best]):.0f}°")
    axis.set_ylim(0, top)
    axis.set_xlabel("\n".join(lines), fontsize="small")


def _round(values: Array) -> Array:
    """A closed curve: the first value once more at the end."""
    return np.append(values, values[0])
