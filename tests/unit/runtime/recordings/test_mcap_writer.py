"""Files of recordings: sinks, writers, snapshot buffers, selections, reading of damaged files."""

import errno
import os
import struct
from collections import Counter
from dataclasses import replace

import pytest

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.encoding import encoding_of
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.bus.ingest_queue import IngestQueue, memory_of
from tailor.runtime.recordings.mcap.scan import MAGIC, DamageReport, scan
from tailor.runtime.recordings.mcap.sink import Sink
from tailor.runtime.recordings.mcap.writer import McapWriter
from tailor.runtime.recordings.recorder import Limits, Recorder
from tailor.runtime.recordings.recording import open_recording
from tailor.runtime.recordings.recording_metadata import RecordingMetadata
from tailor.runtime.recordings.selection import Selection, selection
from tailor.runtime.recordings.snapshot import FailureDetector, SnapshotBuffer
from tailor.runtime.recordings.snapshot_recorder import SnapshotRecorder
from tailor.schemas.codec import encode
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import DriverState, EStop, ExecStatus, Odometry, Provenance
from tailor.schemas.own import example
from tailor.schemas.ros2.action import achieve_goal
from tests.support.patience import wait_until

SENDER = "ab" * 16
EVERYTHING = Selection()
S = 1_000_000_000


def raw(message, sequence=1, key="agilo/odom", **changes):
    fields = {
        "key": key,
        "payload": encode(message),
        "attachment": pack(Origin(sequence, 500 + sequence, SENDER)),
        "encoding": encoding_of(type(message)),
        "is_put": True,
        "received_wall_ns": sequence * S,
    }
    return Raw(**{**fields, **changes})


def odometry(sequence, **changes):
    return raw(Odometry(sequence, float(sequence), 0.0, 0.0, 0.0, 0.0), sequence, **changes)


def write_tape(path, count=50, chunks=5):
    tape = McapWriter(path, {"made": {"by": "test"}})
    for sequence in range(1, count + 1):
        tape.write(odometry(sequence), sequence * S)
        if sequence % (count // chunks) == 0:
            tape.flush()
    tape.close()
    return path


def test_a_recording_reads_back_exactly_what_was_written(tmp_path):
    recording = open_recording(write_tape(tmp_path / "a.mcap"))
    found = list(recording.messages())
    assert [(m.key, m.ros_type, m.sender, m.sequence, m.log_ns, m.publish_ns) for m in found] == [
        ("agilo/odom", "nav_msgs/msg/Odometry", SENDER, k, k * S, 500 + k) for k in range(1, 51)
    ]
    assert [m.data for m in found] == [odometry(k).payload for k in range(1, 51)]
    assert dict(recording.metadata())["made"] == {"by": "test"}
    assert (recording.damage.chunks, recording.damage.text()) == (5, "")


def test_an_unsigned_message_of_a_known_key_gets_its_type_from_the_table(tmp_path):
    tape = McapWriter(tmp_path / "a.mcap", {})
    tape.write(odometry(1, attachment=None, encoding="zenoh/bytes"), 7)
    tape.write(raw(EStop(True), key="some/where", attachment=b"?", encoding="text/plain"), 8)
    tape.close()
    found = list(open_recording(tmp_path / "a.mcap").messages())
    assert [(m.ros_type, m.sender, m.sequence, m.publish_ns) for m in found] == [
        ("nav_msgs/msg/Odometry", "", 0, 7),
        ("", "", 0, 8),
    ]


@pytest.mark.promise("P35")
@pytest.mark.parametrize("share", [0.0, 0.05, 0.3, 0.5, 0.9, 0.99])
def test_a_cut_file_gives_back_every_whole_chunk(tmp_path, share):
    data = write_tape(tmp_path / "a.mcap").read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(data[: max(len(MAGIC), int(len(data) * share))])
    recording = open_recording(cut)
    sequences = [m.sequence for m in recording.messages()]
    assert sequences == list(range(1, len(sequences) + 1))
    assert len(sequences) % 10 == 0
    assert not recording.damage.complete
    assert recording.damage.text().startswith("no footer; ")


def chunk_bounds(data):
    """Places of the bytes inside each chunk record."""
    at = len(MAGIC)
    while data[at] != 0x0F:
        length = struct.unpack_from("<Q", data, at + 1)[0]
        if data[at] == 0x06:
            yield at + 9, at + 9 + length
        at += 9 + length


def test_a_damaged_chunk_costs_its_own_messages_only(tmp_path):
    data = bytearray(write_tape(tmp_path / "a.mcap").read_bytes())
    _, end = next(chunk_bounds(data))
    data[end - 20] ^= 0xFF
    (tmp_path / "bad.mcap").write_bytes(data)
    recording = open_recording(tmp_path / "bad.mcap")
    assert [m.sequence for m in recording.messages()] == list(range(11, 51)), "channels come from the index"
    assert (recording.damage.chunks, recording.damage.damaged_chunks) == (4, 1)
    assert "1 damaged" in recording.damage.text()


@pytest.mark.promise("P40")
def test_flipped_bits_anywhere_never_raise_anything_but_a_usage_error(tmp_path):
    data = write_tape(tmp_path / "a.mcap", count=10, chunks=2).read_bytes()
    path = tmp_path / "bad.mcap"
    for at in range(0, len(data), 7):
        damaged = bytearray(data)
        damaged[at] ^= 1 << (at % 8)
        path.write_bytes(damaged)
        try:
            recording = open_recording(path)
            assert len(list(recording.decoded())) <= 10
        except UsageError:
            pass


@pytest.mark.parametrize("length", [2**63, 2**40, 10**8])
def test_a_record_that_claims_to_be_huge_is_not_read(tmp_path, length):
    path = tmp_path / "bomb.mcap"
    path.write_bytes(MAGIC + struct.pack("<BQ", 6, length) + bytes(100))
    damage = DamageReport()
    assert list(scan(path, damage)) == []
    assert damage.lost_bytes == 109


@pytest.mark.promise("P40")
def test_a_compression_bomb_is_not_unpacked(tmp_path):
    import zstandard

    bomb = zstandard.compress(bytes(300_000_000))
    for declared in (300_000_000, 1000):
        body = (
            struct.pack("<QQQI", 0, 0, declared, 0)
            + struct.pack("<I", 4)
            + b"zstd"
            + struct.pack("<Q", len(bomb))
            + bomb
        )
        path = tmp_path / f"{declared}.mcap"
        path.write_bytes(MAGIC + struct.pack("<BQ", 6, len(body)) + body)
        damage = DamageReport()
        assert list(scan(path, damage)) == []
        assert damage.damaged_chunks == 1


def test_a_file_that_is_no_recording_is_reported_in_one_line(tmp_path):
    (tmp_path / "text").write_text("hello, I am no recording")
    with pytest.raises(UsageError, match="not an MCAP file"):
        open_recording(tmp_path / "text")
    with pytest.raises(UsageError, match="No such file"):
        open_recording(tmp_path / "absent.mcap")


@pytest.mark.promise("P35")
def test_a_changed_schema_is_refused_by_name(tmp_path, monkeypatch):
    write_tape(tmp_path / "a.mcap")
    monkeypatch.setattr("tailor.runtime.recordings.recording.type_hash", lambda _: "RIHS01_other")
    with pytest.raises(UsageError, match=r"nav_msgs/msg/Odometry has changed since"):
        list(open_recording(tmp_path / "a.mcap").messages())


@pytest.mark.promise("P9")
def test_a_full_disk_leaves_whole_blocks_and_the_rest_is_written_when_there_is_space(tmp_path, monkeypatch):
    sink = Sink(tmp_path / "f")
    sink.write(b"first")
    sink.flush()
    real, space = os.write, 3

    def full(file, data):
        nonlocal space
        if space == 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        done = real(file, bytes(data[:space]))
        space -= done
        return done

    monkeypatch.setattr(os, "write", full)
    sink.write(b"second")
    with pytest.raises(OSError, match="No space"):
        sink.flush()
    assert (tmp_path / "f").read_bytes() == b"first"
    assert sink.tell() == 11
    monkeypatch.setattr(os, "write", real)
    sink.write(b"third")
    sink.flush()
    sink.close()
    assert (tmp_path / "f").read_bytes() == b"firstsecondthird"


def make_recorder(tmp_path, queue, wanted=EVERYTHING, **limits):
    return Recorder(tmp_path / "r.mcap", queue, wanted, Limits(**limits), RecordingMetadata("1", 0))


def test_the_recorder_counts_what_a_full_disk_costs_and_goes_on(tmp_path, monkeypatch):
    monkeypatch.setattr("tailor.runtime.recordings.mcap.writer.STUCK_BYTES", 6000)
    queue = IngestQueue()
    recorder = make_recorder(tmp_path, queue)
    real = os.write

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "write", full)
    for sequence in range(1, 31):
        queue.put(odometry(sequence))
        recorder.step(sequence * S)
    steps = iter(range(31 * S, 10**6 * S, S))  # an error appears with the next flush
    wait_until(lambda: recorder.step(next(steps)) or recorder.health.disk_error, "error of the disk", 20.0)
    assert recorder.health.disk_error == "No space left on device"
    lost = recorder.health.drops["agilo/odom"]
    assert 0 < lost < 30
    monkeypatch.setattr(os, "write", real)
    wait_until(lambda: recorder.step(next(steps)) or not recorder._writer.is_full, "a flush that succeeds", 20.0)
    recorder.step(next(steps))
    assert recorder.health.disk_error == ""
    queue.put(odometry(31))
    assert recorder.close().messages == 31 - lost
    recording = open_recording(tmp_path / "r.mcap")
    assert [m.sequence for m in recording.messages()][-1] == 31
    assert dict(recording.metadata())["drops"] == {"agilo/odom": str(lost)}


@pytest.mark.promise("P17")
def test_a_flood_is_dropped_and_counted_before_memory_runs_out():
    queue = IngestQueue(max_bytes=10 * memory_of(odometry(1)) + 1)
    for sequence in range(100):
        queue.put(odometry(sequence))
    kept = len(queue.drain())
    assert kept == 10
    assert queue.drops == Counter({"agilo/odom": 100 - kept})
    queue.put(odometry(100))
    assert len(queue.drain()) == 1, "a drained queue has room again"
    assert (queue.received, queue.drops.total()) == (101, 100 - kept)


def test_a_recording_is_never_written_over_another_one(tmp_path):
    (tmp_path / "r.mcap").write_bytes(b"the last run")
    with pytest.raises(FileExistsError):
        make_recorder(tmp_path, IngestQueue())
    assert (tmp_path / "r.mcap").read_bytes() == b"the last run"


def test_provenance_goes_into_every_part_of_a_recording(tmp_path):
    queue = IngestQueue()
    recorder = make_recorder(tmp_path, queue, max_bytes=1)
    for sequence in range(1, 4):
        queue.put(raw(Provenance(0, '{"seed": 1}'), sequence, "exec/provenance"))
        recorder.step(sequence * S)
    recorder.close()
    parts = sorted(tmp_path.glob("r_*.mcap"))
    assert len(parts) == 4
    for number, part in enumerate(parts):
        metadata = open_recording(part).metadata()
        assert ("provenance", {"sender": SENDER, "json": '{"seed": 1}'}) in metadata
        assert dict(metadata)["part"] == {"number": str(number)}


def test_a_recording_whose_next_file_cannot_be_created_goes_on_in_the_present_one(tmp_path):
    queue = IngestQueue()
    taken = tmp_path / "r_001.mcap"
    recorder = make_recorder(tmp_path, queue, max_bytes=1)
    taken.write_bytes(b"of an earlier recording")
    for tick in (1, 2):
        queue.put(odometry(tick))
        recorder.step(tick * S)
    assert "exists" in recorder.health.disk_error
    assert recorder.health.files == [tmp_path / "r_000.mcap"]
    taken.unlink()
    recorder.step(3 * S)
    queue.put(odometry(3))
    health = recorder.close()
    assert (health.messages, health.disk_error, len(health.files)) == (3, "", 2)
    assert [len(list(open_recording(path).messages())) for path in health.files] == [2, 1]


def test_deletes_and_unwanted_topics_are_not_recorded(tmp_path):
    queue = IngestQueue()
    recorder = make_recorder(tmp_path, queue, selection(["odom"], []))
    queue.put(odometry(1, is_put=False))
    queue.put(raw(EStop(True), 1, "estop"))
    queue.put(odometry(2))
    assert recorder.close().messages == 1


@pytest.mark.parametrize(
    ("include", "exclude", "key", "wanted"),
    [
        ([], [], "anything/at/all", True),
        ([], [], "clock", False),
        (["clock"], [], "clock", True),
        ([], [], achieve_goal().feedback.key(0), False),
        (["*/exec/**"], [], achieve_goal().feedback.key(0), True),
        (["odom"], [], "agilo/odom", True),
        (["odom"], [], "agilo/pose", False),
        (["agilo/*"], [], "agilo/sim/truth", True),
        (["exec/**"], [], "exec/tick", True),
        (["agilo/*"], ["odom"], "agilo/odom", False),
        (["odom,pose"], [], "agilo/pose", True),
        (["nav_msgs/msg/Odometry"], [], "x/y", True),
        ([], ["nav_msgs/msg/Odometry"], "x/y", False),
    ],
)
def test_topics_are_selected_by_name_pattern_or_type(include, exclude, key, wanted):
    assert selection(include, exclude).wants(key, "nav_msgs/msg/Odometry") is wanted


def test_a_misspelt_topic_is_an_error():
    with pytest.raises(UsageError, match="topic 'odmo'"):
        selection(["odmo"], [])


def status(mode, sequence=1):

    return raw(replace(example(ExecStatus), mode=mode, reason="why"), sequence, "exec/status")


def driver(mode):

    return raw(replace(example(DriverState), mode=mode, reason="why"), 1, "agilo/driver")


def test_a_failure_is_detected_once():
    failure = FailureDetector()
    failures = [
        failure.detect(r) for r in (status("READY"), status("FAULT"), status("FAULT"), status("READY"), odometry(1))
    ]
    assert failures == ["", "exec/status: FAULT: why", "", "", ""]
    assert [failure.detect(r) for r in (driver("armed"), driver("stopped"), driver("armed"))] == [
        "",
        "agilo/driver: stopped: why",
        "",
    ]


def test_a_driver_that_was_stopped_before_is_no_failure():
    assert FailureDetector().detect(driver("stopped")) == ""


def test_a_snapshot_buffer_keeps_only_the_last_seconds(tmp_path):
    buffer = SnapshotBuffer(5 * S)
    for k in range(1, 21):
        buffer.add(odometry(k), 1, k * S)
    assert buffer.write(tmp_path / "ring.mcap", {}) == 6
    assert [m.sequence for m in open_recording(tmp_path / "ring.mcap").messages()] == list(range(15, 21))


@pytest.mark.promise("P22")
@pytest.mark.parametrize("jump_s", [3600, -3600])
def test_a_jump_of_the_wall_clock_splits_no_recording_and_delays_no_split(tmp_path, jump_s):
    queue = IngestQueue()
    recorder = make_recorder(tmp_path, queue, max_ns=10 * S)
    for k in range(1, 25):  # of the monotonic clock, from an arbitrary origin
        queue.put(replace(odometry(k), received_wall_ns=(10_000 + k + jump_s * (k > 5)) * S))
        recorder.step((500 + k) * S)
    assert [len(list(open_recording(path).messages())) for path in recorder.close().files] == [11, 11, 2]


@pytest.mark.promise("P22")
@pytest.mark.parametrize("jump_s", [3600, -3600])
def test_a_jump_of_the_wall_clock_changes_nothing_in_what_a_snapshot_holds(tmp_path, jump_s):
    buffer = SnapshotBuffer(5 * S)
    for k in range(1, 21):
        buffer.add(odometry(k), (10_000 + k + jump_s * (k > 17)) * S, k * S)
    assert buffer.write(tmp_path / "ring.mcap", {}) == 6
    assert {m.sequence for m in open_recording(tmp_path / "ring.mcap").messages()} == set(range(15, 21))


def test_a_snapshot_buffer_is_bounded_in_bytes_too(tmp_path):
    buffer = SnapshotBuffer(1000 * S, max_bytes=10 * memory_of(odometry(1)))
    for k in range(1, 21):
        buffer.add(odometry(k), k * S, k * S)
    assert buffer.write(tmp_path / "ring.mcap", {}) == 10


def test_a_snapshot_buffer_drops_a_message_that_alone_is_too_large():
    buffer = SnapshotBuffer(S, max_bytes=memory_of(odometry(1)) - 1)
    buffer.add(odometry(1), S, S)
    assert buffer.is_empty


def test_a_snapshot_of_nothing_is_refused(tmp_path):
    queue = IngestQueue()
    recorder = SnapshotRecorder(
        tmp_path / "s.mcap", queue, Selection(), SnapshotBuffer(100 * S), RecordingMetadata("1", 0)
    )
    assert not recorder.request_snapshot("by hand", 0)
    recorder.step(0)
    queue.put(odometry(1))
    recorder.step(1)
    assert list(tmp_path.iterdir()) == []
    assert recorder.request_snapshot("by hand", 2)
    recorder.step(2)
    assert [m.sequence for m in open_recording(tmp_path / "s_000.mcap").messages()] == [1]


def test_a_failure_is_noticed_in_messages_that_are_not_recorded(tmp_path):
    queue = IngestQueue()
    only_odometry = SnapshotRecorder(
        tmp_path / "s.mcap", queue, selection(["odom"], []), SnapshotBuffer(100 * S), RecordingMetadata("1", 0)
    )
    queue.put(odometry(1))
    for sequence, mode in enumerate(("EXECUTING", "FAULT")):
        queue.put(status(mode, sequence))
    only_odometry.step(0)
    only_odometry.step(2 * S)
    (written,) = only_odometry.health.files
    assert [m.key for m in open_recording(written).messages()] == ["agilo/odom"]


@pytest.fixture
def full_disk(monkeypatch):
    """Call with True and False: whether the disk is full."""
    from tailor.runtime.recordings.mcap import sink

    def refuse(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    really = sink.os.write
    return lambda full: monkeypatch.setattr(sink.os, "write", refuse if full else really)


def test_what_a_full_disk_kept_out_of_the_file_counts_as_unwritten_and_not_as_recorded(tmp_path, full_disk):
    queue = IngestQueue()
    recorder = make_recorder(tmp_path, queue)
    for sequence in (1, 2):
        queue.put(odometry(sequence))
        recorder.step(sequence * S)
    steps = iter(range(3 * S, 10**6 * S, S))
    wait_until(lambda: recorder.step(next(steps)) or recorder._writer._sink.pending == 0, "the disk")
    full_disk(True)
    for sequence in (3, 4, 5):
        queue.put(odometry(sequence))
        recorder.step(next(steps))
    health = recorder.close()
    found = [m.sequence for m in open_recording(tmp_path / "r.mcap").messages()]
    assert found == [1, 2]
    assert (health.messages, health.unwritten, health.disk_error) == (2, 3, "No space left on device")
    assert health.bytes == (tmp_path / "r.mcap").stat().st_size


def test_a_file_that_could_not_be_ended_for_want_of_space_is_counted_after_the_next_one_began(tmp_path, full_disk):
    queue = IngestQueue()
    recorder = make_recorder(tmp_path, queue, max_bytes=1)
    full_disk(True)
    queue.put(odometry(1))
    recorder.step(S)
    full_disk(False)
    queue.put(odometry(2))
    health = recorder.close()
    assert len(health.files) == 2
    assert (health.messages, health.unwritten) == (1, 1)


def test_a_snapshot_that_fails_on_a_full_disk_is_reported_and_the_next_one_is_written(tmp_path, full_disk):
    queue = IngestQueue()
    recorder = SnapshotRecorder(
        tmp_path / "s.mcap", queue, Selection(), SnapshotBuffer(100 * S), RecordingMetadata("1", 0)
    )
    queue.put(odometry(1))
    recorder.step(0)
    full_disk(True)
    recorder.request_snapshot("by hand", 1)
    recorder.step(1)
    assert recorder.health.disk_error == "No space left on device"
    assert (recorder.health.files, list(tmp_path.iterdir())) == ([], [])
    full_disk(False)
    recorder.request_snapshot("again", 2)
    recorder.step(2)
    assert [path.name for path in recorder.health.files] == ["s_000.mcap"]
    assert recorder.health.disk_error == ""


def test_snapshots_of_an_earlier_recorder_are_kept_and_cost_none_of_the_new_ones(tmp_path):
    (tmp_path / "s_000.mcap").write_text("of yesterday")
    queue = IngestQueue()
    recorder = SnapshotRecorder(
        tmp_path / "s.mcap", queue, Selection(), SnapshotBuffer(100 * S), RecordingMetadata("1", 0)
    )
    queue.put(odometry(1))
    recorder.step(0)
    for k in (1, 2):
        recorder.request_snapshot("by hand", k)
        recorder.step(k)
    assert [path.name for path in recorder.health.files] == ["s_001.mcap", "s_002.mcap"]
    assert (tmp_path / "s_000.mcap").read_text() == "of yesterday"


@pytest.mark.parametrize("at_the_end", [True, False])
def test_two_recorders_of_one_failure_write_a_snapshot_each(tmp_path, monkeypatch, at_the_end):
    free, taken = SnapshotRecorder._free_path, []

    def raced(self):
        path = free(self)
        if not taken:
            path.write_text("of the other one")
        taken.append(path)
        return path

    monkeypatch.setattr(SnapshotRecorder, "_free_path", raced)
    queue = IngestQueue()
    recorder = SnapshotRecorder(
        tmp_path / "s.mcap", queue, Selection(), SnapshotBuffer(100 * S), RecordingMetadata("1", 0)
    )
    queue.put(odometry(1))
    recorder.step(0)
    recorder.request_snapshot("by hand", 1)
    for _ in range(0 if at_the_end else 2):
        recorder.step(1)
    assert [path.name for path in recorder.close().files] == ["s_001.mcap"]
    assert (tmp_path / "s_000.mcap").read_text() == "of the other one"
    assert recorder.health.disk_error == ""


def test_a_run_that_does_not_fit_on_the_disk_raises(tmp_path, full_disk):
    from tailor.tools.lockstep.run_writer import RunWriter
    from tests.support.toy_domain import line_context

    tape = RunWriter(tmp_path / "run.mcap", line_context(), {})
    full_disk(True)
    with pytest.raises(OSError, match="No space left on device"):
        tape.close()


def test_a_snapshot_is_written_a_second_after_a_failure_and_on_request(tmp_path):
    queue = IngestQueue()
    recorder = SnapshotRecorder(
        tmp_path / "s.mcap", queue, Selection(), SnapshotBuffer(100 * S), RecordingMetadata("1", 0)
    )
    for k, message in enumerate([odometry(1), status("READY", 2), status("FAULT", 3)]):
        queue.put(message)
        recorder.step(k * S // 10)
    assert list(tmp_path.iterdir()) == []
    queue.put(odometry(4))
    recorder.step(2 * S)
    recorder.request_snapshot("by hand", 3 * S)
    recorder.step(3 * S)
    health = recorder.close()
    assert [p.name for p in health.files] == ["s_000.mcap", "s_001.mcap"]
    first = open_recording(health.files[0])
    assert [m.sequence for m in first.messages()] == [1, 2, 3, 4]
    assert dict(first.metadata())["snapshot"] == {"reason": "exec/status: FAULT: why"}
    assert dict(open_recording(health.files[1]).metadata())["snapshot"] == {"reason": "by hand"}


@pytest.fixture
def snapshots(tmp_path):
    """A recorder of snapshots of 10 s that has had a message and an executive's fault, at 0 s, and its queue."""
    queue = IngestQueue()
    path, kept = tmp_path / "s.mcap", SnapshotBuffer(10 * S)
    recorder = SnapshotRecorder(path, queue, EVERYTHING, kept, RecordingMetadata("1", 0))
    for raw in (odometry(1), status("EXECUTING", 1), status("FAULT", 2)):
        queue.put(raw)
    recorder.step(0)
    return recorder, queue


def test_a_snapshot_that_found_a_full_disk_is_written_once_there_is_room(snapshots, full_disk):
    recorder, _ = snapshots
    full_disk(True)
    for second in range(1, 6):
        recorder.step(second * S)
    assert (recorder.health.files, recorder.health.disk_error) == ([], "No space left on device")
    full_disk(False)
    recorder.step(7 * S)
    (written,) = recorder.health.files
    assert [m.key for m in open_recording(written).messages()] == ["agilo/odom", "exec/status", "exec/status"]
    assert recorder.health.disk_error == ""
    assert "FAULT" in dict(open_recording(written).metadata())["snapshot"]["reason"]
    recorder.step(30 * S)
    assert len(recorder.health.files) == 1


def test_a_snapshot_is_given_up_once_its_messages_have_left_the_memory_and_the_loss_stays_reported(
    snapshots, full_disk
):
    recorder, queue = snapshots
    full_disk(True)
    for second in range(1, 14):
        recorder.step(second * S)
    full_disk(False)
    queue.put(odometry(2))
    recorder.step(14 * S)
    assert (recorder.close().files, recorder.health.disk_error) == ([], "No space left on device")


def test_a_later_failure_takes_the_place_of_a_snapshot_that_waits_for_room(snapshots, full_disk):
    recorder, queue = snapshots
    full_disk(True)
    recorder.step(1 * S)
    for raw in (status("EXECUTING", 3), status("FAULT", 4)):
        queue.put(raw)
    recorder.step(8 * S)
    full_disk(False)
    recorder.step(9 * S)
    (written,) = recorder.health.files
    assert [m.sequence for m in open_recording(written).messages()] == [1, 1, 2, 3, 4]


def test_the_end_of_a_recorder_is_the_last_attempt_at_a_snapshot(snapshots, full_disk):
    recorder, _ = snapshots
    full_disk(True)
    recorder.step(1 * S)
    assert recorder.close().disk_error == "No space left on device"
