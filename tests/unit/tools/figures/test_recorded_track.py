"""Tracks out of recordings, read as they go."""

from dataclasses import replace
from pathlib import Path

import pytest

from tailor.runtime.recordings import recording
from tailor.runtime.recordings.mcap.writer import McapWriter
from tailor.runtime.recordings.recording import open_recording
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


def two_runs(path, *names):
    """A recording of several runs one after another."""
    writer = McapWriter(path, {})
    for number, name in enumerate(names):
        for recorded in open_recording(GOLDEN / f"{name}.mcap").messages():
            own = (("key", recorded.key), ("sender", f"{number + 1}{recorded.sender[1:]}"))
            later_ns = number * 30 * 10**9
            sent = (recorded.log_ns + later_ns, recorded.data, recorded.publish_ns + later_ns, recorded.sequence)
            writer.copy(recorded.key, replace(recorded.declared, metadata=own), sent)
    writer.close()
    return path


@pytest.mark.parametrize("second", ["soccer-kicked-ball", "arm-word-I"])
def test_of_two_runs_in_a_file_the_first_is_drawn_and_the_other_named(tmp_path, capsys, second):
    """Their actions have the same numbers, so they were drawn as one; joints of an arm passed for a drive."""
    first = recorded_track("t", GOLDEN / "soccer-approach-dribble.mcap")
    capsys.readouterr()
    track = recorded_track("t", two_runs(tmp_path / "two.mcap", "soccer-approach-dribble", second))
    assert track == first
    named = "two.mcap holds 2 runs: the first one, of executive 10000000, is drawn\n"
    assert capsys.readouterr().err == named


def test_a_run_without_an_action_is_not_the_first_one(tmp_path, capsys):
    """An executive that was started anew may do all the work."""
    track = recorded_track("t", GOLDEN / "soccer-approach-dribble.mcap")
    idle = tmp_path / "idle.mcap"
    writer = McapWriter(idle, {})
    for recorded in open_recording(GOLDEN / "arm-word-I.mcap").messages():
        if recorded.key == "exec/provenance":
            sent = (recorded.log_ns, recorded.data, recorded.publish_ns, recorded.sequence)
            writer.copy(recorded.key, replace(recorded.declared, metadata=(("sender", "ab" * 16),)), sent)
    for recorded in open_recording(GOLDEN / "soccer-approach-dribble.mcap").messages():
        sent = (recorded.log_ns, recorded.data, recorded.publish_ns, recorded.sequence)
        writer.copy(recorded.key, recorded.declared, sent)
    writer.close()
    assert recorded_track("t", idle) == track
    assert capsys.readouterr().err == ""
