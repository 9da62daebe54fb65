"""The paper's Figures 15 and 16 a: durations over the place of an asserted subgoal, where it may lie, and both runs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from tailor.executive.interfaces.values import Array
from tailor.tools.cli.output_files import whole_output
from tailor.tools.evaluations.assertion.subgoal_map import SubgoalMap
from tailor.tools.figures.paths import corners, draw_side_by_side
from tailor.tools.figures.track import Track

ARROW_M = 0.3


def draw_subgoal_map(ground: SubgoalMap, tracks: Sequence[Track], title: str, path: Path) -> None:
    """Draw into a PNG: seconds to the subgoal, from it, and their sum; below, predicted success and two runs.

    Args:
      ground: The search space.
      tracks: The run without and the run with assertion; the first has the objects.
      title: Above all.
      path: Where to; its folder is made.
    """
    figure = Figure(figsize=(15, 9.6), layout="constrained")
    figure.suptitle(
        f"{title}; blank: the way there or the one from there fails in more than {100 * ground.limit:.0f} %"
    )
    axes = figure.subplots(2, 3)
    tables = (
        ("goToPose to the subgoal (s)", ground.first_s),
        ("approachBall from there (s)", ground.second_s),
        ("sum (s)", ground.total_s),
    )
    for axis, (name, table) in zip(axes[0], tables, strict=True):
        _map(figure, axis, ground, tracks[0], table, name)
    _mark_least(axes[0, 2], ground)
    _map(figure, axes[1, 0], ground, tracks[0], ground.success, "predicted success, there and from there", "RdYlGn")
    axes[1, 0].contour(ground.x, ground.y, ground.success, levels=[1 - ground.limit], colors="black", linewidths=1)
    draw_side_by_side(axes[1, 1:], tracks)
    with whole_output(path) as whole:
        figure.savefig(whole, dpi=100)


def _mark_least(axis: Any, ground: SubgoalMap) -> None:
    if np.isfinite(ground.total_s).any():
        row, column = np.unravel_index(int(np.nanargmin(ground.total_s)), ground.total_s.shape)
        where = (ground.x[column], ground.y[row])
        axis.plot(*where, "o", color="white", markeredgecolor="black", label="least on this grid")
        axis.legend(loc="best", fontsize="small")


def _map(
    figure: Figure, axis: Any, ground: SubgoalMap, track: Track, table: Array, name: str, cmap: str = "viridis"
) -> None:
    """One table over the ground, with objects, start, goal and the subgoal as chosen."""
    limits = (0.0, 1.0) if cmap != "viridis" else (None, None)
    shown = axis.pcolormesh(ground.x, ground.y, table, cmap=cmap, shading="nearest", vmin=limits[0], vmax=limits[1])
    figure.colorbar(shown, ax=axis, shrink=0.85)
    for each, outline in track.outlines.items():
        first = next(point.objects[each] for point in track.points if each in point.objects)
        axis.fill(*corners(outline, first), facecolor=outline.colour[:3], zorder=3)
    axis.plot(*ground.start, "s", color="black", markersize=7, zorder=4)
    axis.annotate("start", ground.start, xytext=(6, 6), textcoords="offset points", fontsize="small")
    for (x, y, phi), colour in ((ground.goal, "black"), (ground.subgoal, "dimgrey")):
        dx, dy = ARROW_M * math.cos(phi), ARROW_M * math.sin(phi)
        axis.arrow(x, y, dx, dy, color=colour, width=0.014, head_width=0.1, length_includes_head=True, zorder=4)
    axis.plot(ground.subgoal[0], ground.subgoal[1], "+", color="dimgrey", markersize=11, markeredgewidth=2, zorder=5)
    axis.set(aspect="equal", xlabel="x (m)", ylabel="y (m)")
    axis.set_title(name, fontsize="medium")
