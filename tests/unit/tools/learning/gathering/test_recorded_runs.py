"""Gathering from recordings: what is recorded is used, once, and what is damaged is left out and reported."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tailor.models.episodes import episodes, manifest, whole_files
from tailor.models.episodes.episodes import read_data_set
from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.encoding import encoding_named
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.recordings.mcap.writer import McapWriter
from tailor.runtime.recordings.recording import Recorded, open_recording
from tailor.schemas.codec import decode, encode
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import Odometry
from tailor.tools.lockstep import bodies
from tailor.tools.main import main
from tests.unit.runtime.recordings.test_mcap_writer import chunk_bounds

RECORDING = Path(__file__).parents[4] / "data" / "golden" / "soccer-approach-dribble.mcap"

pytestmark = pytest.mark.usefixtures("few_draws")


def test_a_recording_that_is_named_twice_is_refused(tmp_path: Path, capsys) -> None:
    copy = shutil.copy(RECORDING, tmp_path / "copy.mcap")
    for twice in (RECORDING, copy):
        assert main(["gather", "agilo", "--from", str(RECORDING), str(twice), "--out", str(tmp_path / "x")]) == 2
        message = f"{twice}: holds the same approachBall as {RECORDING}, expected each run once"
        assert message in capsys.readouterr().err
    assert not (tmp_path / "x").exists()


def test_a_recording_gives_data_sets_of_the_actions_in_it_and_of_no_others(tmp_path: Path, capsys) -> None:
    cut = ["gather", "agilo", "--from", str(RECORDING), "--out", str(tmp_path), "--json"]
    assert main(cut) == 0
    counts = json.loads(capsys.readouterr().out)
    assert counts["approachBall"] == 1
    assert {path.name for path in tmp_path.iterdir()} == {action for action, count in counts.items() if count}
    assert main(cut) == 2  # what is there is not overwritten
    assert "holds episodes already" in capsys.readouterr().err


def test_recordings_that_the_disk_has_no_space_for_leave_no_part_of_a_data_set(tmp_path, monkeypatch, capsys) -> None:
    """Half of the episodes stayed, beside a manifest that named all recordings, and no command continued them."""
    write, written = whole_files.write_whole, []

    def full(path: Path, content: bytes) -> None:
        written.append(path)
        if len(written) == 4:
            raise UsageError(f"{path}: No space left on device")
        write(path, content)

    cut = ["gather", "agilo", "--from", str(RECORDING), "--out", str(tmp_path / "x")]
    with monkeypatch.context() as patched:
        for module in (episodes, manifest):
            patched.setattr(module, "write_whole", full)
        assert main(cut) == 2
    last = written[-1].relative_to(written[-1].parents[1])
    assert capsys.readouterr().err == f"tailor gather: {tmp_path / 'x' / last}: No space left on device\n"
    assert not (tmp_path / "x").exists()
    assert main(cut) == 0


def test_recordings_need_no_simulated_body(tmp_path: Path, monkeypatch) -> None:
    def none(_: object) -> None:
        raise UsageError("the robot has no body")

    bodies.body_of.cache_clear()
    monkeypatch.setattr(bodies, "new_body", none)
    assert main(["gather", "agilo", "--from", str(RECORDING), "--out", str(tmp_path), "--json"]) == 0


def test_a_recording_of_another_robot_is_refused(tmp_path: Path, capsys) -> None:
    assert main(["gather", "powercube", "--from", str(RECORDING), "--out", str(tmp_path / "x")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.endswith(f"{RECORDING}: recorded action 'approachBall', expected one of powercube: reach")
    assert not (tmp_path / "x").exists()


def damaged(recorded: Recorded) -> bytes:
    """The bytes of a message that no reader accepts: an odometry that is no number, or half a message."""
    message = decode(Odometry, recorded.data) if recorded.key == "agilo/odom" else None
    return encode(replace(message, x=float("nan"))) if isinstance(message, Odometry) else recorded.data[:20]


def copy_with_damage(path: Path, key: str, numbers: set[int]) -> Path:
    """A copy of the recording in which these messages of a key, counted from 0, are damaged."""
    writer, seen = McapWriter(path, {}), 0
    for recorded in open_recording(RECORDING).messages():
        data = damaged(recorded) if recorded.key == key and seen in numbers else recorded.data
        seen += recorded.key == key
        origin = pack(Origin(recorded.sequence, recorded.publish_ns, recorded.sender))
        writer.write(Raw(key=recorded.key, payload=data, attachment=origin,
                         encoding=encoding_named(recorded.ros_type), is_put=True, received_wall_ns=None),
                     recorded.log_ns)  # fmt: skip
    writer.close()
    return path


@pytest.fixture
def gather(tmp_path: Path, capsys):
    """Gather from a recording: number of episodes by action, what is reported, and the folder."""

    def run(path: Path) -> tuple[dict[str, int], str, Path]:
        out = tmp_path / path.stem
        assert main(["gather", "agilo", "--from", str(path), "--out", str(out), "--json"]) == 0
        printed = capsys.readouterr()
        return json.loads(printed.out), printed.err, out

    return run


def test_a_sensor_message_that_is_no_number_is_left_out_and_the_rest_is_used(gather, tmp_path: Path) -> None:
    counts, reported, whole = gather(RECORDING)
    assert reported == ""
    damaged_copy = copy_with_damage(tmp_path / "copy.mcap", "agilo/odom", {30, 31, 100})
    fewer, reported, out = gather(damaged_copy)
    assert fewer == counts
    assert reported.split() == f"{damaged_copy}: left out 3 messages of agilo/odom (not finite)".split()
    for action in ("approachBall", "dribbleBall"):
        one, other = read_data_set(whole / action), read_data_set(out / action)
        (a,), (b,) = one.episodes, other.episodes
        assert np.array_equal(a.ticks, b.ticks)
        assert a.work_j is not None
        assert b.work_j is None  # the drives' work needs every state of motion
        assert other.manifest["left_out"] == {"copy.mcap": {"agilo/odom": 3}}
        assert "left_out" not in one.manifest


@pytest.mark.parametrize(
    ("key", "number", "left"),
    [
        ("exec/status", 30, {"dribbleBall": 1}),
        ("exec/finished", 0, {"dribbleBall": 1}),
        ("exec/finished", 1, {"approachBall": 1}),
    ],
)
def test_an_action_of_which_the_executive_s_own_words_are_damaged_is_left_out(
    key, number, left, gather, tmp_path: Path
) -> None:
    counts, reported, _ = gather(copy_with_damage(tmp_path / "copy.mcap", key, {number}))
    assert {action: count for action, count in counts.items() if count} == left
    assert f"left out 1 message of {key}, with the action that ran (malformed)" in " ".join(reported.split())


def chunked(path: Path, set_back_ns: int = 0) -> Path:
    """A copy of the recording in chunks; in the midst of its first action the clock may be set back."""
    writer = McapWriter(path, {})
    for number, recorded in enumerate(open_recording(RECORDING).messages()):
        back_ns = set_back_ns if number >= 300 else 0
        sent = (recorded.log_ns - back_ns, recorded.data, recorded.publish_ns - back_ns, recorded.sequence)
        writer.copy(recorded.key, recorded.declared, sent)
        if number % 60 == 59:
            writer.flush()
    writer.close()
    return path


def test_an_action_in_the_midst_of_which_a_chunk_is_damaged_is_left_out(gather, tmp_path: Path) -> None:
    """Its episode lacked ticks, so what was learned of the others had a wrong time to go; nothing was reported."""
    path = chunked(tmp_path / "copy.mcap")
    data = bytearray(path.read_bytes())
    start, end = list(chunk_bounds(data))[4]
    data[(start + end) // 2] ^= 0xFF
    path.write_bytes(data)
    counts, reported, _ = gather(path)
    assert {action: count for action, count in counts.items() if count} == {"dribbleBall": 1}
    words = " ".join(reported.split())
    assert "copy.mcap is damaged: 14 chunks intact, 1 damaged" in words
    assert "messages of exec/status, with the action that ran (missing)" in words


def test_an_action_during_which_the_clock_was_set_back_is_left_out(gather, tmp_path: Path) -> None:
    """Its ticks before and after that were mixed."""
    counts, reported, _ = gather(chunked(tmp_path / "copy.mcap", set_back_ns=500_000_000))
    assert {action: count for action, count in counts.items() if count} == {"dribbleBall": 1}
    assert "of exec/status, with the action that ran (missing, out of order)" in " ".join(reported.split())


def test_an_action_of_an_executive_that_was_killed_is_not_continued_by_the_next_one(gather, tmp_path: Path) -> None:
    """Number and goal of the actions are equal, so they were taken for one, of as many ticks as both."""
    _, _, alone = gather(RECORDING)
    path, messages = tmp_path / "copy.mcap", list(open_recording(RECORDING).messages())
    writer = McapWriter(path, {})
    for recorded, later_ns in [*((m, 0) for m in messages[:300]), *((m, 30 * 10**9) for m in messages)]:
        sender = recorded.sender if later_ns == 0 or recorded.sender[0] == "d" else "ab" * 16
        origin = pack(Origin(recorded.sequence + 1000 * (later_ns > 0), recorded.publish_ns + later_ns, sender))
        encoding = encoding_named(recorded.ros_type)
        writer.write(Raw(recorded.key, recorded.data, origin, encoding, True, None), recorded.log_ns + later_ns)
    writer.close()
    _, reported, out = gather(path)
    assert reported == ""
    (one,), (other,) = (read_data_set(folder / "approachBall").episodes for folder in (alone, out))
    assert np.array_equal(one.ticks, other.ticks)


def test_a_goal_that_cannot_be_read_is_never_replaced_by_the_one_before(gather, tmp_path: Path) -> None:
    whole, _, _ = gather(RECORDING)
    last = sum(recorded.key == "exec/subgoals" for recorded in open_recording(RECORDING).messages()) - 1
    counts, _, _ = gather(copy_with_damage(tmp_path / "last.mcap", "exec/subgoals", {last}))
    assert counts == {**whole, "dribbleBall": 0}


def test_a_recording_without_a_whole_action_is_refused_with_what_was_left_out(tmp_path: Path, capsys) -> None:
    path = copy_with_damage(tmp_path / "copy.mcap", "exec/finished", {0, 1})
    assert main(["gather", "agilo", "--from", str(path), "--out", str(tmp_path / "x")]) == 2
    refused = " ".join(capsys.readouterr().err.split())
    assert "no finished action" in refused
    assert "left out 2 messages of exec/finished" in refused
    assert not (tmp_path / "x").exists()
