"""Letters in the manner of the paper's Figure 13 (b): a row for each hand, in joint space or as the pen went.

The line's colour is the speed, dots are waypoints; ways to a letter's first waypoint are thin.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from tailor.executive.interfaces.values import Array
from tailor.tools.cli.output_files import whole_output
from tailor.tools.writing.measures import pen_m
from tailor.tools.writing.writing_track import WritingTrack

MAX_RADPS = 1.0  # brightest colour
COLOURS = "viridis"
GRID = 0.4  # rad in joint space; half of it in metres on the page
CELL_INCHES = 2.1
WORD_INCHES = 9.0
MAX_HEIGHT_INCHES = 4.0  # of one hand
MARGIN = 0.25  # m or rad around the waypoints


def draw_letters(rows: Sequence[Sequence[WritingTrack]], path: Path) -> None:
    """Draw a grid: one row for each hand, one column for each letter, all in joint space to one scale."""
    count = len(rows[0])
    figure = Figure(figsize=(CELL_INCHES * count + 1.2, CELL_INCHES * 1.3 * len(rows)), layout="constrained")
    axes = figure.subplots(len(rows), count, squeeze=False, sharex=True, sharey=True)
    for line, row in zip(axes, rows, strict=True):
        for axis, track in zip(line, row, strict=True):
            lines = _draw(axis, track, track.angles, track.waypoints)
            axis.set_title(f"{track.duration_s:.1f} s", fontsize="medium")
        line[0].set_ylabel(f"{row[0].title}\nlift b (rad)")
    for axis in axes[-1]:
        axis.set_xlabel("pan a (rad)")
    _finish(figure, axes, lines, path, GRID)


def draw_words(rows: Sequence[WritingTrack], path: Path, in_joints: bool = False) -> None:
    """Draw one text by several hands below each other, at the scale of the page in metres, or in joint space."""
    place, unit = ((lambda angles: angles), "rad") if in_joints else (pen_m, "m")
    page = place(rows[0].waypoints)
    (left, low), (right, high) = page.min(axis=0) - MARGIN, page.max(axis=0) + MARGIN
    scale = min(WORD_INCHES / (right - left), MAX_HEIGHT_INCHES / (high - low))
    figure = Figure(
        figsize=(scale * (right - left) + 2.0, (scale * (high - low) + 0.4) * len(rows) + 0.4), layout="constrained"
    )
    axes = figure.subplots(len(rows), 1, squeeze=False, sharex=True, sharey=True)
    for (axis,), track in zip(axes, rows, strict=True):
        lines = _draw(axis, track, place(track.angles), place(track.waypoints))
        axis.set_title(f"{track.title}: {track.duration_s:.1f} s", fontsize="medium")
        axis.set(ylabel=f"{'lift b' if in_joints else 'up'} ({unit})", xlim=(left, right), ylim=(low, high))
    axes[-1, 0].set_xlabel(f"{'pan a' if in_joints else 'right'} ({unit})")
    _finish(figure, axes, lines, path, GRID / 2)


def _draw(axis: Any, track: WritingTrack, line: Array, points: Array) -> LineCollection:
    """One piece of writing on one axis; returns its line, for the scale of colours."""
    speed = np.linalg.norm(track.velocities, axis=1)
    segments = np.stack((line[:-1], line[1:]), axis=1)
    drawn = LineCollection(list(segments), cmap=COLOURS, capstyle="round")
    drawn.set_array(0.5 * (speed[:-1] + speed[1:]))
    drawn.set_clim(0.0, MAX_RADPS)
    drawn.set_linewidth(np.where(track.pen_down()[1:], 2.4, 0.5).tolist())
    axis.add_collection(drawn)
    axis.autoscale_view()
    axis.plot(*points.T, "o", color="black", markersize=3, zorder=3)
    return drawn


def _finish(figure: Figure, axes: Any, lines: LineCollection, path: Path, grid: float) -> None:
    for axis in axes.flat:
        axis.set_aspect("equal")
        axis.xaxis.set_major_locator(MultipleLocator(grid))
        axis.yaxis.set_major_locator(MultipleLocator(grid))
        axis.spines[["top", "right"]].set_visible(False)
        axis.grid(alpha=0.2)
    figure.colorbar(lines, ax=axes, label="joint speed (rad/s)", shrink=0.6, aspect=30, pad=0.01)
    with whole_output(path) as whole:
        figure.savefig(whole, dpi=130)
