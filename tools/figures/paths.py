"""Paths like the paper's Figure 1: lines across the robot's heading, 10 a second, whose length is its speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from matplotlib import collections as mc
from matplotlib.figure import Figure
from matplotlib.transforms import ScaledTranslation

from tailor.tools.figures.track import Track, TrackPoint
from tailor.tools.scenes.flat import Outline, Point

COLOURS = ("#1f77b4", "#ff7f0e", "#2ca02c", "#d62728", "#9467bd", "#8c564b", "#17becf")  # one for each in the legend
HALF_WIDTH_PER_SPEED_S = 0.16  # a robot at 0.9 m/s draws a line 0.29 m wide
SCALE_MPS = 0.5
LABELLED = len(COLOURS)  # actions in the legend; a run that fails may repeat its last one many times
PANEL_IN, HIGHEST_IN, FRAME_IN = 4.4, 6.4, 2.0  # width of a field, its greatest height, and what title and legend take
LEGEND_IN = 0.5  # from an axis down to its legend: ticks and name of the axis lie between, however flat it is


def draw_paths(tracks: list[Track], path: Path) -> None:
    """Draw the runs side by side, to the same scale, into a PNG."""
    path.parent.mkdir(parents=True, exist_ok=True)
    figure_of(tracks).savefig(path, dpi=130)


def figure_of(tracks: list[Track]) -> Figure:
    """The runs side by side, to the same scale."""
    figure = Figure(figsize=size_in(tracks), layout="constrained")
    draw_side_by_side(figure.subplots(1, len(tracks), squeeze=False)[0], tracks)
    return figure


def draw_side_by_side(axes: Sequence[Any], tracks: Sequence[Track]) -> None:
    """Draw one run an axis, all to one scale; the first shows the scale of the speed."""
    limits = limits_of(tracks)
    headed = any(p.phi is not None for track in tracks for p in track.points)
    names = ("x (m)", "y (m)") if headed else ("right (m)", "up (m)")
    for axis, track in zip(axes, tracks, strict=True):
        draw_path(axis, track)
        axis.set(xlim=limits[0], ylim=limits[1], aspect="equal", xlabel=names[0], ylabel=names[1])
        axis.grid(alpha=0.25)
    if headed:
        _draw_scale(axes[0], limits)


def _draw_scale(axis: Any, limits: tuple[tuple[float, float], tuple[float, float]]) -> None:
    """A line as long as the speed SCALE_MPS."""
    x, y = limits[0][0] + 0.1, limits[1][0] + 0.1
    axis.plot([x, x + 2 * HALF_WIDTH_PER_SPEED_S * SCALE_MPS], [y, y], color="black", linewidth=1.4)
    axis.text(x, y + 0.04, f"{SCALE_MPS} m/s", fontsize="x-small")


def draw_path(axis: Any, track: Track) -> None:
    """Draw one run: lines across the heading, objects, subgoals, and a legend with the actions' durations."""
    names: list[str] = []
    for number in sorted({point.action for point in track.points}):
        points = [point for point in track.points if point.action == number]
        colour = COLOURS[len(names) % len(COLOURS)]
        if any(p.phi is not None for p in points):
            axis.add_collection(mc.LineCollection([across(p) for p in points], colors=colour, linewidths=1.4))
        else:
            axis.plot(*line_through(points, [(p.x, p.y) for p in points]), color=colour, linewidth=1.8)
        axis.plot([], [], color=colour, label=_label(track, number, points[0].name))
        names.append(points[0].name)
    _draw_objects(axis, track)
    draw_goals(axis, track)
    axis.set_title(f"{track.title}: {track.actual_s:.1f} s", parse_math=False)
    _draw_legend(axis)


def _draw_legend(axis: Any) -> None:
    """The first actions' colours, below the axis: a run may fill all of it."""
    handles, labels = axis.get_legend_handles_labels()
    if len(labels) > LABELLED + 1:
        (rest,) = axis.plot([], [], linestyle="none")
        handles, labels = [*handles[:LABELLED], rest], [*labels[:LABELLED], f"and {len(labels) - LABELLED} more"]
    if labels:
        below = axis.transAxes + ScaledTranslation(0.0, -LEGEND_IN, axis.figure.dpi_scale_trans)
        place = {"loc": "upper center", "bbox_to_anchor": (0.5, 0.0), "bbox_transform": below}
        axis.legend(handles, labels, ncols=2, fontsize="small", **place)


def line_through(points: Sequence[TrackPoint], places: Sequence[Point]) -> tuple[list[float], list[float]]:
    """Coordinates of a line through the places of points, x and y apart, broken (NaN) where the driver restarts."""
    gap = (math.nan, math.nan)
    broken = [
        each
        for point, before, place in zip(points, [*points[:1], *points], places, strict=False)
        for each in ([place] if point.restart == before.restart else [gap, place])
    ]
    return [x for x, _ in broken], [y for _, y in broken]


def across(point: TrackPoint) -> list[tuple[float, float]]:
    """The line across the heading, its length the speed."""
    half = HALF_WIDTH_PER_SPEED_S * abs(point.v) + 0.005
    phi = point.phi or 0.0
    dx, dy = -math.sin(phi) * half, math.cos(phi) * half
    return [(point.x - dx, point.y - dy), (point.x + dx, point.y + dy)]


def _label(track: Track, number: int, name: str) -> str:
    for action in track.finished:
        if action.action_index == number:
            return f"{name} {action.actual_s:.1f} s (predicted {action.predicted_s:.1f})"
    return name


def _draw_objects(axis: Any, track: Track) -> None:
    """Path of every object, with its outline filled at the start and bare at the end."""
    for name in sorted(track.outlines):
        points = [point for point in track.points if name in point.objects]
        places = [point.objects[name] for point in points]
        outline, colour = track.outlines[name], track.outlines[name].colour[:3]
        axis.plot(*line_through(points, [p[:2] for p in places]), color=colour, linewidth=0.8, alpha=0.5, zorder=0)
        axis.fill(*corners(outline, places[0]), facecolor=colour, zorder=3)
        axis.fill(*corners(outline, places[-1]), fill=False, edgecolor=colour, zorder=3)


def corners(outline: Outline, place: tuple[float, float, float]) -> tuple[list[float], list[float]]:
    """Coordinates of an outline at a place, x and y apart."""
    x, y, phi = place
    c, s = math.cos(phi), math.sin(phi)
    return [x + c * a - s * b for a, b in outline.points], [y + s * a + c * b for a, b in outline.points]


def draw_goals(axis: Any, track: Track) -> None:
    """A mark at every subgoal as last chosen for its action, an arrow if it has a heading; grey for free ones."""
    for goal in track.goals:
        (x, y), colour = goal.place, "dimgrey" if goal.free else "black"
        if goal.phi is not None:
            style = {"color": colour, "width": 0.012, "head_width": 0.09, "zorder": 4}
            dx, dy = 0.3 * math.cos(goal.phi), 0.3 * math.sin(goal.phi)
            axis.arrow(x, y, dx, dy, length_includes_head=True, **style)
        axis.plot([x], [y], marker="+" if goal.free else "*", color=colour, zorder=4)


def size_in(tracks: Sequence[Track]) -> tuple[float, float]:
    """Width and height of a picture of runs side by side, in inches: as flat as the field that they cover."""
    (left, right), (low, high) = limits_of(tracks)
    return (PANEL_IN + 0.8) * len(tracks), min(PANEL_IN * (high - low) / (right - left), HIGHEST_IN) + FRAME_IN


def limits_of(tracks: Sequence[Track]) -> tuple[tuple[float, float], tuple[float, float]]:
    """Common limits with a margin, metres; a unit square without any motion."""
    points = [point for track in tracks for point in track.points]
    goals = [goal.place for track in tracks for goal in track.goals]
    xs = [p.x for p in points] + [x for x, _ in goals] or [0.0, 1.0]
    ys = [p.y for p in points] + [y for _, y in goals] or [0.0, 1.0]
    margin = 0.5 if any(p.phi is not None for p in points) else 0.1
    return (min(xs) - margin, max(xs) + margin), (min(ys) - margin, max(ys) + margin)
