"""Floods of sender ids, keys and types: the recorder lives, its file stays readable, and the loss is counted."""

import hashlib
from collections import Counter
from dataclasses import replace

import pytest
from mcap.reader import make_reader

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.encoding import encoding_of
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.bus.ingest_queue import OTHER_KEYS, IngestQueue
from tailor.runtime.recordings.mcap import channel_table
from tailor.runtime.recordings.mcap.channel_table import MAX_KEYS, MAX_SENDERS
from tailor.runtime.recordings.recorder import Limits, Recorder
from tailor.runtime.recordings.recording import open_recording
from tailor.runtime.recordings.recording_metadata import RecordingMetadata
from tailor.runtime.recordings.selection import Selection
from tailor.runtime.recordings.snapshot import FailureDetector, SnapshotBuffer
from tailor.schemas.codec import encode
from tailor.schemas.messages import DriverState, Odometry, Provenance
from tailor.schemas.own import example
from tailor.schemas.typesystem import ros_type

S = 1_000_000_000
ODOMETRY, DRIVER = encode(example(Odometry)), encode(example(DriverState))


def sender(number):
    return hashlib.md5(str(number).encode(), usedforsecurity=False).hexdigest()


def odometry(number, key="agilo/odom", by=0):
    encoding = encoding_of(Odometry)
    return Raw(key, ODOMETRY, pack(Origin(number, number, sender(by))), encoding, True, number + S)


def recorded(path, messages, **limits):
    """Health of a recorder that has written the messages into a file."""
    queue = IngestQueue()
    recorder = Recorder(path, queue, Selection(), Limits(**limits), RecordingMetadata("1", 0))
    for number, raw in enumerate(messages):
        queue.put(raw)
        if number % 5000 == 4999:
            recorder.step(number * S)
    return recorder.close()


@pytest.mark.promise("P50")
def test_more_sender_ids_than_mcap_can_number_are_recorded_without_loss(tmp_path):
    path, count = tmp_path / "r.mcap", 66_150
    health = recorded(path, (odometry(number, by=number) for number in range(1, count + 1)))
    assert (health.messages, health.drops) == (count, Counter())
    assert health.mixed == {"agilo/odom": count - MAX_SENDERS}
    with path.open("rb") as file:
        channels = make_reader(file).get_summary().channels
    assert len(channels) == MAX_SENDERS + 1
    assert [c.metadata["mixed"] for c in channels.values() if "mixed" in c.metadata] == [channel_table.MIXED]
    recording = open_recording(path)
    found = [(message.sequence, message.sender) for message in recording.messages()]
    assert found == [(k, sender(k) if k <= MAX_SENDERS else "") for k in range(1, count + 1)]
    assert dict(recording.metadata())["mixed"] == {"agilo/odom": str(count - MAX_SENDERS)}


@pytest.mark.promise("P50")
def test_a_flood_of_senders_on_one_key_leaves_other_keys_their_senders(tmp_path):
    flood = [odometry(number, by=number) for number in range(1, 301)]
    health = recorded(tmp_path / "r.mcap", [*flood, odometry(1, "powercube/odom", by=5)])
    assert set(health.mixed) == {"agilo/odom"}
    assert [m.sender for m in open_recording(tmp_path / "r.mcap").messages()][-1] == sender(5)


def test_types_of_one_key_do_not_share_a_channel(tmp_path):
    driver = Raw("agilo/odom", DRIVER, pack(Origin(1, 1, sender(999))), encoding_of(DriverState), True, S)
    recorded(tmp_path / "r.mcap", [*(odometry(number, by=number) for number in range(1, 301)), driver])
    *_, before, last = open_recording(tmp_path / "r.mcap").messages()
    assert (before.ros_type, before.sender) == (ros_type(Odometry), "")
    assert (last.ros_type, last.sender) == (ros_type(DriverState), sender(999))


def test_made_up_types_take_no_channels(tmp_path):
    flood = [
        Raw("agilo/odom", b"x", pack(Origin(k, k, sender(1))), f"application/cdr;made/up{k}", True, S + k)
        for k in range(1, 2001)
    ]
    assert recorded(tmp_path / "r.mcap", flood).messages == 2000
    with (tmp_path / "r.mcap").open("rb") as file:
        assert len(make_reader(file).get_summary().channels) == 1


def test_keys_beyond_the_limit_are_dropped_and_counted(tmp_path):
    health = recorded(tmp_path / "r.mcap", [odometry(k, f"key/{k}") for k in range(1, 3001)])
    assert health.messages == MAX_KEYS
    assert health.drops.total() == 3000 - MAX_KEYS
    assert health.drops[OTHER_KEYS] == 3000 - MAX_KEYS - 1000, "the counts have a limit, too"
    recording = open_recording(tmp_path / "r.mcap")
    assert sum(map(int, dict(recording.metadata())["drops"].values())) == 3000 - MAX_KEYS
    assert sum(1 for _ in recording.messages()) == MAX_KEYS


def test_many_senders_on_many_keys_stay_below_the_limit_of_all(tmp_path, monkeypatch):
    monkeypatch.setattr(channel_table, "MAX_CHANNELS", 50)
    flood = [odometry(1, f"key/{key}", by=by) for key in range(20) for by in range(10)]
    health = recorded(tmp_path / "r.mcap", flood)
    assert (health.messages, health.mixed.total()) == (200, 150)
    with (tmp_path / "r.mcap").open("rb") as file:
        assert len(make_reader(file).get_summary().channels) == 50 + 15


def test_every_part_of_a_split_recording_has_the_limits_and_the_sum_is_reported(tmp_path):
    queue = IngestQueue()
    recorder = Recorder(tmp_path / "r.mcap", queue, Selection(), Limits(max_bytes=1), RecordingMetadata("1", 0))
    for part in range(3):
        for by in range(150):
            queue.put(odometry(by + 1, by=by))
        recorder.step((part + 1) * S)
    health = recorder.close()
    assert health.mixed == {"agilo/odom": 150}
    assert len(health.files) == 4


def test_a_snapshot_has_the_same_limits(tmp_path):
    buffer = SnapshotBuffer(100 * S)
    for k in range(1, 1001):
        buffer.add(odometry(k, f"key/{k}"), S + k, S + k)
    assert buffer.write(tmp_path / "s.mcap", {}) == MAX_KEYS
    assert len(dict(open_recording(tmp_path / "s.mcap").metadata())["drops"]) == 1000 - MAX_KEYS


@pytest.mark.parametrize("size", [0, 10])
def test_a_flood_of_small_messages_is_bounded_in_memory(size):
    queue = IngestQueue(max_bytes=1_000_000)
    for k in range(10_000):
        queue.put(Raw("key", bytes(size), None, "", True, k))
    assert len(queue.drain()) < 2000
    assert queue.drops["key"] > 8000


def test_counts_that_change_for_hours_are_noted_every_ten_seconds_only(tmp_path):
    queue = IngestQueue()
    recorder = Recorder(tmp_path / "r.mcap", queue, Selection(), Limits(), RecordingMetadata("1", 0))
    for step in range(600):
        queue._drops["some/key"] += 1
        recorder.step(step * S // 10)
    recorder.close()
    notes = [entries for name, entries in open_recording(tmp_path / "r.mcap").metadata() if name == "drops"]
    assert len(notes) == 7
    assert notes[-1] == {"some/key": "600"}


def driver(mode, by):
    payload = encode(replace(example(DriverState), mode=mode, reason="why"))
    return Raw("agilo/driver", payload, pack(Origin(1, 1, sender(by))), encoding_of(DriverState), True, S)


def test_a_stopped_driver_beside_another_one_is_one_failure():
    """A snapshot was written every second, of 30 s each, until the disk was full."""
    detector = FailureDetector()
    found = [detector.detect(driver("armed", by)) for by in (1, 2)]
    for _ in range(5):
        found += [detector.detect(driver(mode, by)) for mode, by in (("stopped", 1), ("armed", 2))]
    assert [each for each in found if each] == ["agilo/driver: stopped: why"]


def test_a_failure_is_detected_after_a_flood_of_senders():
    detector = FailureDetector()
    for by in range(MAX_KEYS + 5):
        assert not detector.detect(driver("armed", by))
    assert len(detector._modes) == MAX_KEYS
    assert detector.detect(driver("stopped", MAX_KEYS)) == "agilo/driver: stopped: why"


def test_the_provenance_of_two_executives_is_written_once_each(tmp_path):
    """25 MB an hour were written, and as many entries were kept in memory until the file was closed."""

    def provenance(by, text):
        payload = encode(Provenance(0, text))
        return Raw("exec/provenance", payload, pack(Origin(1, 1, sender(by))), encoding_of(Provenance), True, S)

    path = tmp_path / "r.mcap"
    recorded(path, [provenance(by, f"of {by}") for _ in range(50) for by in (1, 2)] + [provenance(1, "anew")])
    kept = [entries["json"] for name, entries in open_recording(path).metadata() if name == "provenance"]
    assert kept == ["of 1", "of 2", "anew"]


def test_a_flood_of_executives_is_not_remembered():
    metadata = RecordingMetadata("1", 0)
    for by in range(100):
        metadata.observe(
            Raw("exec/provenance", encode(Provenance(0, "x")), pack(Origin(1, 1, sender(by))), "", True, S)
        )
    assert len(metadata._provenances) <= 32
