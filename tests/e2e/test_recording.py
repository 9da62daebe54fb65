"""The recorder as a process of its own: its files, also after kill -9."""

import os
import signal
import sys
import time
from dataclasses import replace

import numpy as np
import pytest

from tailor.runtime.processes.child import Child
from tailor.runtime.recordings.mcap.scan import DamageReport
from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import Odometry, Provenance
from tests.support.bus_system import bus_system
from tests.support.patience import PATIENCE_S, wait_until
from tests.support.stalls import repeat_on_stall


@pytest.fixture
def robot(tmp_path):
    """A bus with a stand-in robot that publishes; yields (session, start_recorder)."""
    with bus_system() as (session, endpoint, start):
        start("tests.support.stand_ins.sim", endpoint, tmp_path / "trace")
        states = session.inbox(["driver"], "agilo")
        wait_until(states.drain, "driver state")

        def record(path, *options):
            return start("tailor.tools.main", "record", "-o", path, "--connect", endpoint, *options)

        yield session, record


def readable(path):
    """Messages in a file that may still be growing."""
    return list(open_recording(path).messages()) if path.exists() and path.stat().st_size else []


def test_a_recording_holds_every_message_in_order_and_decodes(robot, tmp_path):
    session, record = robot
    path = tmp_path / "run.mcap"
    expected = {"agilo/odom", "agilo/pose", "agilo/ball", "agilo/driver", "agilo/sim/truth"}
    recorder = record(path)
    wait_until(lambda: readable(path), "first messages")
    session.publisher("provenance", "").publish(Provenance(0, '{"seed": 3}'))
    wait_until(lambda: {r.key for r in readable(path)} >= {*expected, "exec/provenance"}, "a message of each kind")
    os.kill(recorder.pid, signal.SIGINT)
    assert recorder.wait(PATIENCE_S) == 0
    recording = open_recording(path)
    found = list(recording.decoded())
    assert recording.damage == DamageReport(chunks=recording.damage.chunks, complete=True)
    assert not [value for _, value in found if isinstance(value, Rejected)]
    odometry = [recorded for recorded, value in found if isinstance(value, Odometry)]
    assert [r.sequence for r in odometry] == list(range(odometry[0].sequence, odometry[-1].sequence + 1))
    assert len({r.sender for r in odometry}) == 1
    assert expected <= {r.key for r, _ in found}
    metadata = dict(recording.metadata())
    assert metadata["provenance"]["json"] == '{"seed": 3}'
    assert metadata["provenance"]["sender"] == session.sender
    assert {"recorder", "topics"} <= metadata.keys()


@pytest.mark.promise("P9", "P35")
def test_kill_9_of_the_recorder_loses_at_most_a_second(robot, tmp_path):
    _, record = robot
    for number in range(2):

        def killed(after_s=1.4 + 0.4 * number, path=tmp_path / f"{number}.mcap"):
            path.unlink(missing_ok=True)
            recorder = record(path)
            wait_until(lambda: readable(path), "first messages")
            time.sleep(after_s)  # who writes only once in a while has lost as much by now
            killed_ns = time.time_ns()
            recorder.kill()
            recording = open_recording(path)
            last_ns = max(r.log_ns for r in recording.messages())
            assert not recording.damage.complete
            assert recording.damage.damaged_chunks == 0
            assert (killed_ns - last_ns) / 1e9 <= 1.0

        repeat_on_stall(3, killed)


def test_only_selected_messages_are_recorded(robot, tmp_path):
    _, record = robot
    path = tmp_path / "some.mcap"
    recorder = record(path, "--topics", "agilo/*", "--exclude", "odom,geometry_msgs/msg/PoseWithCovarianceStamped")
    wait_until(lambda: {r.key for r in readable(path)} & {"agilo/ball", "agilo/driver"}, "first messages")
    assert recorder.stop(PATIENCE_S) == 0
    keys = {r.key for r in readable(path)}
    assert keys & {"agilo/ball", "agilo/driver"}
    assert not keys & {"agilo/odom", "agilo/pose"}


def test_a_long_recording_continues_in_new_files_without_a_gap(robot, tmp_path):
    _, record = robot
    recorder = record(tmp_path / "part.mcap", "--max-duration", 0.8)
    wait_until((tmp_path / "part_002.mcap").exists, "third file")
    assert recorder.stop(PATIENCE_S) == 0
    sequences = [
        r.sequence for path in sorted(tmp_path.glob("part_*.mcap")) for r in readable(path) if r.key == "agilo/odom"
    ]
    assert sequences == list(range(sequences[0], sequences[-1] + 1))


def test_a_file_that_exists_is_not_overwritten(tmp_path):
    path = tmp_path / "old.mcap"
    path.write_bytes(b"precious")
    with bus_system() as (_, endpoint, _start):
        command = [sys.executable, "-P", "-m", "tailor.tools.main", "record", "-o", str(path), "--connect", endpoint]
        with (tmp_path / "log").open("w") as log:
            assert Child("recorder", command, log).wait(PATIENCE_S) == 2
    assert "exists already" in (tmp_path / "log").read_text()
    assert path.read_bytes() == b"precious"


def test_a_snapshot_is_written_on_request_only(robot, tmp_path):
    session, record = robot
    record(tmp_path / "snap.mcap", "--snapshot", 5)
    wait_until(lambda: session.call("recorder/snapshot", "by hand", 0.2)[0], "snapshot recorder")
    path = tmp_path / "snap_000.mcap"
    wait_until(lambda: readable(path), "snapshot")
    assert dict(open_recording(path).metadata())["snapshot"] == {"reason": "by hand"}


def test_record_replay_record_is_byte_identical(tmp_path):
    with bus_system() as (session, endpoint, start):

        def record(name):
            recorder = start("tailor.tools.main", "record", "-o", tmp_path / name, "--connect", endpoint)
            marker = session.player("marker", "")
            wait_until(marker.matched, "recorder")
            return recorder

        sim = start("tests.support.stand_ins.sim", endpoint, tmp_path / "trace")
        wait_until(session.inbox(["driver"], "agilo").drain, "driver state")
        recorder = record("a.mcap")
        wait_until(lambda: len(readable(tmp_path / "a.mcap")) > 150, "two seconds of messages")
        recorder.stop(PATIENCE_S)
        sim.stop()
        recorder = record("b.mcap")
        player = start("tailor.tools.main", "replay", tmp_path / "a.mcap", "--rate", 2, "--connect", endpoint)
        assert player.wait(PATIENCE_S) == 0
        recorder.stop(PATIENCE_S)
        first, second = (list(open_recording(tmp_path / name).messages()) for name in ("a.mcap", "b.mcap"))
    assert [replace(m, log_ns=0) for m in first] == [replace(m, log_ns=0) for m in second]
    times = [np.array([message.log_ns for message in messages]) for messages in (first, second)]
    half = len(first) // 2
    spans = [np.median(each[half : 2 * half] - each[:half]) for each in times]  # one stall does not move a median
    assert abs(spans[0] / spans[1] - 2) < 0.3
