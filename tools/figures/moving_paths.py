"""Recorded runs that move, in step from their first actions: the picture of `paths.py`, frame by frame."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

from matplotlib import collections as mc
from matplotlib.animation import PillowWriter
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from tailor.schemas.errors import UsageError
from tailor.tools.figures.paths import COLOURS, across, corners, draw_goals, limits_of, line_through, size_in
from tailor.tools.figures.track import Track, TrackPoint

SUFFIXES = (".gif", ".webp", ".apng")
FRAMES_PER_S = 10  # as many as a track has points
HOLD_S = 2.5  # at the end
DOTS_PER_INCH = 72
MAX_S = 300.0  # of a run: all frames are in memory until the end, half a megabyte each and run


class MovingPath:
    """One run on an axis: its way so far, its robot and its objects."""

    def __init__(self, axis: Any, track: Track) -> None:
        self.track = track
        self._axis = axis
        starts = track.points[:1] + [b for a, b in pairwise(track.points) if a.action != b.action]
        self._colours = {p.action: COLOURS[i % len(COLOURS)] for i, p in enumerate(starts)}
        self._way = axis.add_collection(mc.LineCollection([], linewidths=1.4))
        self._line = axis.plot([], [], color=COLOURS[0], linewidth=1.8)[0]  # of a robot without a heading
        self._parts = [
            (outline, name, axis.add_patch(Polygon([(0.0, 0.0)], facecolor=outline.colour[:3], zorder=zorder)))
            for shapes, zorder in ((track.body, 4), (track.outlines, 5))
            for name, outline in shapes.items()
        ]
        for patch in (patch for outline, _, patch in self._parts if outline.on_robot):
            patch.set_edgecolor("black")

    def show(self, since_s: float) -> None:
        """Show the moment so many seconds after the first action's start."""
        points = [p for p in self.track.points if p.time_s - self.track.points[0].time_s <= since_s + 1e-6]
        headed = [p for p in points if p.phi is not None]
        self._way.set(segments=[across(p) for p in headed], colors=[self._colours[p.action] for p in headed])
        self._line.set_data(*line_through(points, [] if headed else [(p.x, p.y) for p in points]))
        now = points[-1]
        for outline, name, patch in self._parts:
            place = (now.x, now.y, now.phi or 0.0) if outline.on_robot else now.objects.get(name)
            patch.set_visible(place is not None)
            if place is not None:
                patch.set_xy(list(zip(*corners(outline, place), strict=True)))
        self._axis.set_title(f"{self.track.title}: {_words(self.track, now, since_s)}", parse_math=False)


def _words(track: Track, now: TrackPoint, since_s: float) -> str:
    return f"{track.actual_s:.1f} s" if now is track.points[-1] else f"{since_s:.1f} s, {now.name}"


def _seconds(track: Track) -> float:
    """Time from the first action to the end of the last one."""
    seconds = track.points[-1].time_s - track.points[0].time_s
    if not 0.0 <= seconds <= MAX_S:
        expected = f"expected 0 to {MAX_S:g} s for a picture that moves (a .png stands still; see `tailor cut`)"
        raise UsageError(f"{track.title}: its actions take {seconds:.1f} s, {expected}")
    return seconds


def move_paths(tracks: Sequence[Track], path: Path, frames_per_s: int = FRAMES_PER_S, hold_s: float = HOLD_S) -> None:
    """Draw the runs side by side, to the same scale and in step, into an animated picture.

    Args:
      tracks: The runs; each has a point.
      path: Its suffix is the format, one of SUFFIXES.
      frames_per_s: Frames for each second of the runs, which the picture shows as fast as they were.
      hold_s: Duration of the last frame.

    Raises:
      UsageError: A run takes too long, or its times go backward.
    """
    longest_s = max(map(_seconds, tracks))
    figure = Figure(figsize=size_in(tracks), layout="constrained", dpi=DOTS_PER_INCH)
    limits = limits_of(tracks)
    paths = []
    for axis, track in zip(figure.subplots(1, len(tracks), squeeze=False)[0], tracks, strict=True):
        axis.set(xlim=limits[0], ylim=limits[1], aspect="equal")
        axis.grid(alpha=0.25)
        draw_goals(axis, track)
        paths.append(MovingPath(axis, track))
    paths[0].show(0.0)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # nothing moves but what is drawn
    path.parent.mkdir(parents=True, exist_ok=True)
    writer = PillowWriter(frames_per_s)
    with writer.saving(figure, str(path), DOTS_PER_INCH):
        for frame in range(int((longest_s + hold_s) * frames_per_s) + 1):
            for each in paths:
                each.show(frame / frames_per_s)
            writer.grab_frame()
