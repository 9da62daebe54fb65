"""Tracks out of recordings, read as they go."""

from dataclasses import replace
from pathlib import Path

import pytest

from tailor.runtime.recordings import recording
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import DriverState, ExecStatus, Provenance
from tailor.tools.figures.recorded_track import recorded_track
from tailor.tools.figures.track import READ, track_of
from tailor.tools.main import main

GOLDEN = Path(__file__).parents[3] / "data" / "golden"


@pytest.mark.parametrize(("name", "domain"), [("soccer-approach-dribble", "soccer"), ("arm-word-I", "arm")])
def test_a_track_decodes_only_what_it_is_made_of(name, domain, monkeypatch):
    """A recording of hours went into memory, every message decoded: most are of no use to it."""
    path, decoded = GOLDEN / f"{name}.mcap", set()
    everything = [each for _, each in recording.open_recording(path).decoded() if not isinstance(each, Rejected)]
    decode = recording.decode
    monkeypatch.setattr(recording, "decode", lambda kind, data: decoded.add(kind) or decode(kind, data))
    track = recorded_track("t", path)
    monkeypatch.undo()
    assert track == track_of("t", everything, domain)
    assert decoded <= {Provenance, *READ}
    assert {type(each) for each in everything} - decoded


def test_names_in_a_recording_reach_no_terminal_as_control_characters():
    """matplotlib warns of a character that it cannot draw, and prints it as it is."""
    own = [each for _, each in recording.open_recording(GOLDEN / "soccer-approach.mcap").decoded(READ)]
    status = {"action": "drive\x1b[2J", "result": "failed", "result_detail": "\x1b[1m"}
    forged = [replace(each, **status) if isinstance(each, ExecStatus) else each for each in own]
    track = track_of("t", forged, "soccer")
    assert {point.name for point in track.points} == {"drive\\x1b[2J"}
    assert track.result.startswith("failed: ")
    assert track.result.isprintable()


def test_a_scene_that_raises_is_named_where_nothing_can_be_drawn(tmp_path, monkeypatch, capsys):
    """It passed for a run in which nothing was executed."""
    monkeypatch.setattr("tailor.robots.soccer_scene.of_truth", lambda message: {}["colour"])
    monkeypatch.setattr("tailor.robots.soccer_scene.of_belief", lambda values: {}["colour"])
    path = GOLDEN / "soccer-approach.mcap"
    assert main(["picture", str(path), "-o", str(tmp_path / "p.png")]) == 2
    expected = "its robot's scene cannot be drawn: of_belief: KeyError: 'colour'"
    assert capsys.readouterr().err == f"tailor picture: {path}: {expected}\n"


def test_a_track_counts_the_restarts_of_the_driver() -> None:
    own = [each for _, each in recording.open_recording(GOLDEN / "soccer-approach.mcap").decoded(READ)]
    half = len(own) // 2
    anew = [replace(each, epoch=each.epoch + 1) if isinstance(each, DriverState) else each for each in own[half:]]
    restarts = [point.restart for point in track_of("t", own[:half] + anew, "soccer").points]
    assert restarts == sorted(restarts)
    assert set(restarts) == {0, 1}
    assert {point.restart for point in track_of("t", own, "soccer").points} == {0}
