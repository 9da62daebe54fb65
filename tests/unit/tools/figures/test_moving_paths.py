"""A picture that moves shows the runs in step, and each of its frames is one moment."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib import image
from matplotlib.figure import Figure

from tailor.schemas.errors import UsageError
from tailor.tools.commands.look import picture
from tailor.tools.figures.moving_paths import MovingPath, move_paths
from tailor.tools.figures.track import Track, TrackPoint
from tailor.tools.scenes.flat import Outline

BALL = Outline(((-0.1, 0.0), (0.1, 0.0), (0.0, 0.1)), True, (1.0, 0.4, 0.1, 1.0))
BODY = Outline(((-0.2, -0.1), (0.2, -0.1), (0.2, 0.1)), True, (0.5, 0.5, 0.5, 1.0), on_robot=True, robots=True)


def track(title: str, moments: int, phi: float | None = 0.0) -> Track:
    points = [
        TrackPoint(7.0 + 0.1 * i, 0.1 * i, 0.0, phi, 1.0, {"ball": (1.0 + 0.1 * i, 0.0, 0.0)}, i // 3, "go")
        for i in range(moments)
    ]
    return Track(title, points, {"ball": BALL}, {"body": BODY})


@pytest.mark.parametrize("phi", [0.0, None])
def test_a_moment_shows_the_way_so_far_and_things_where_they_are(phi) -> None:
    axis = Figure().subplots()
    path = MovingPath(axis, track("run", 8, phi))
    path.show(0.3)
    assert len(axis.collections[0].get_segments()) + len(axis.lines[0].get_xdata()) == 4
    body, ball = (np.mean(patch.get_xy()[:3, 0]) for patch in axis.patches)
    assert (body, ball) == (pytest.approx(0.3 + 0.2 / 3), pytest.approx(1.3))
    path.show(5.0)
    assert axis.get_title() == "run: 0.0 s", "a run that has ended stays, with the sum of its actions"


def test_the_picture_is_written_in_the_format_of_its_name(tmp_path: Path) -> None:
    move_paths([track("a", 3), track("b", 5)], tmp_path / "runs.gif", frames_per_s=5, hold_s=0)
    assert (tmp_path / "runs.gif").read_bytes()[:4] == b"GIF8"
    assert image.imread(tmp_path / "runs.gif").shape[1] > 700


def test_a_recording_without_an_action_has_no_picture_that_moves(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr("tailor.tools.figures.recorded_track.recorded_track", lambda title, path: Track(title))
    with pytest.raises(UsageError, match=r"still\.mcap: no action"):
        picture.run(argparse.Namespace(recording=[Path("still.mcap")], output=tmp_path / "a.webp"))


@pytest.mark.parametrize("last_s", [3600.0, 1e9, 1.0])
def test_a_run_whose_frames_would_fill_the_memory_or_has_none_is_refused(tmp_path: Path, last_s: float) -> None:
    """Times of foreign recordings jump: the first two took all memory, the last one ended in a traceback."""
    jumping = track("run", 5)
    jumping.points[-1] = replace(jumping.points[-1], time_s=last_s)
    with pytest.raises(UsageError, match=r"run: its actions take .* s, expected 0 to 300 s"):
        move_paths([track("a", 3), jumping], tmp_path / "runs.gif", frames_per_s=0 if last_s > 100 else 10)
    assert not list(tmp_path.iterdir())
