"""Paths like the paper's Figure 1: lines across the robot's heading, 10 a second, whose length is its speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from matplotlib import collections as mc
from matplotlib.figure import Figure

from tailor.schemas.messages import InstantiatedAction
from tailor.tools.figures.track import Point, Track

COLOURS = ("#1f77b4", "#ff7f0e", "#2ca02c", "#d62728", "#9467bd")
HALF_WIDTH_PER_SPEED_S = 0.16  # a robot at 0.9 m/s draws a line 0.29 m wide
SCALE_MPS = 0.5
OBJECT_RADIUS_M = 0.11


def draw_paths(tracks: list[Track], path: Path) -> None:
    """Draw the runs side by side, to the same scale, into a PNG."""
    figure = Figure(figsize=(5.2 * len(tracks), 5.4), layout="constrained")
    axes = figure.subplots(1, len(tracks), squeeze=False)[0]
    draw_side_by_side(axes, tracks)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=130)


def draw_side_by_side(axes: Sequence[Any], tracks: Sequence[Track]) -> None:
    """Draw one run an axis, all to one scale; the first shows the scale of the speed."""
    limits = _limits(tracks)
    for axis, track in zip(axes, tracks, strict=True):
        draw_path(axis, track)
        axis.set(xlim=limits[0], ylim=limits[1], aspect="equal", xlabel="x (m)", ylabel="y (m)")
        axis.grid(alpha=0.25)
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
        axis.add_collection(mc.LineCollection([_across(p) for p in points], colors=colour, linewidths=1.4))
        axis.plot([], [], color=colour, label=_label(track, number, points[0].name))
        names.append(points[0].name)
    _draw_objects(axis, track)
    _draw_goals(axis, track)
    axis.set_title(f"{track.title}: {track.actual_s:.1f} s")
    axis.legend(loc="best", fontsize="small")


def _across(point: Point) -> list[tuple[float, float]]:
    """The line across the heading, its length the speed."""
    half = HALF_WIDTH_PER_SPEED_S * abs(point.v) + 0.005
    dx, dy = -math.sin(point.phi) * half, math.cos(point.phi) * half
    return [(point.x - dx, point.y - dy), (point.x + dx, point.y + dy)]


def _label(track: Track, number: int, name: str) -> str:
    for action in track.finished:
        if action.action_index == number:
            return f"{name} {action.actual_s:.1f} s (predicted {action.predicted_s:.1f})"
    return name


def _draw_objects(axis: Any, track: Track) -> None:
    """Path of every object, with a disc at its start and a circle at its end."""
    from matplotlib.patches import Circle

    for name in sorted({name for point in track.points for name in point.objects}):
        places = [point.objects[name] for point in track.points if name in point.objects]
        axis.plot(*zip(*places, strict=True), color="orangered", linewidth=0.8, alpha=0.5, zorder=0)
        axis.add_patch(Circle(places[0], OBJECT_RADIUS_M, color="orangered", zorder=3))
        axis.add_patch(Circle(places[-1], OBJECT_RADIUS_M, fill=False, color="orangered", zorder=3))


def _draw_goals(axis: Any, track: Track) -> None:
    """An arrow at every subgoal as last chosen for its action; grey for free ones."""
    for action in _executed(track):
        values = {p.name: p for p in action.parameters}
        if not {"xg", "yg", "phig"} <= values.keys():
            continue
        free = not values["phig"].bound
        x, y, phi = (values[name].value for name in ("xg", "yg", "phig"))
        style = {"color": "dimgrey" if free else "black", "width": 0.012, "head_width": 0.09, "zorder": 4}
        axis.arrow(x, y, 0.3 * math.cos(phi), 0.3 * math.sin(phi), length_includes_head=True, **style)
        axis.plot([x], [y], marker="+" if free else "*", color=style["color"], zorder=4)


def _executed(track: Track) -> list[InstantiatedAction]:
    """The executed actions: the first of every published sequence, each in its last version."""
    latest: dict[tuple[int, bool, str], InstantiatedAction] = {}
    for subgoals in track.subgoals:
        if subgoals.actions:
            action = subgoals.actions[0]
            latest[(action.step, action.asserted, action.action)] = action
    return list(latest.values())


def _limits(tracks: Sequence[Track]) -> tuple[tuple[float, float], tuple[float, float]]:
    """Common limits with a margin, metres; a unit square without any motion."""
    points = [point for track in tracks for point in track.points]
    goals = [{p.name: p.value for p in action.parameters} for track in tracks for action in _executed(track)]
    xs = [p.x for p in points] + [g["xg"] for g in goals if "xg" in g] or [0.0, 1.0]
    ys = [p.y for p in points] + [g["yg"] for g in goals if "yg" in g] or [0.0, 1.0]
    margin = 0.5
    return (min(xs) - margin, max(xs) + margin), (min(ys) - margin, max(ys) + margin)
