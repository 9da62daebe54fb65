"""The index of a long recording waits on the disk: memory is flat, and the file the same as mcap's own, bit for bit."""

import errno
import os
import tempfile
import tracemalloc

import pytest
from mcap.reader import make_reader
from mcap.writer import Writer
from rosbags.highlevel import AnyReader

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.encoding import encoding_of
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.recordings.mcap import chunk_index_spool
from tailor.runtime.recordings.mcap.chunk_index_spool import CHUNK_INDEXES, ChunkIndexSpool
from tailor.runtime.recordings.mcap.writer import McapWriter
from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.codec import encode
from tailor.schemas.messages import Odometry
from tailor.schemas.own import example

S = 1_000_000_000
PAYLOAD = encode(example(Odometry))
KEYS = [f"robot{k}/odom" for k in range(12)]


def write(path, chunks):
    """A file of so many chunks with a message of each key."""
    writer = McapWriter(path, {})
    for number in range(1, chunks + 1):
        add_chunk(writer, number)
    writer.close()
    return path


def add_chunk(writer, number):
    for key in KEYS:
        origin = pack(Origin(number, number, "ab" * 16))
        writer.write(Raw(key, PAYLOAD, origin, encoding_of(Odometry), True, None), number * S)
    writer.flush()


@pytest.fixture
def small_blocks(monkeypatch):
    monkeypatch.setattr(chunk_index_spool, "BLOCK_BYTES", 1000)


def test_mcap_still_keeps_its_index_in_the_attribute_that_is_replaced(tmp_path):
    assert getattr(Writer(str(tmp_path / "x")), CHUNK_INDEXES) == []


def test_the_file_equals_that_of_mcap_bit_for_bit(tmp_path, monkeypatch, small_blocks):
    write(tmp_path / "spooled.mcap", 100)
    monkeypatch.setattr(ChunkIndexSpool, "install", lambda *_: None)
    write(tmp_path / "mcap.mcap", 100)
    assert (tmp_path / "spooled.mcap").read_bytes() == (tmp_path / "mcap.mcap").read_bytes()
    assert len(os.listdir(tmp_path)) == 2, "nothing else is left behind"


def test_a_long_recording_opens_in_other_readers(tmp_path, small_blocks):
    path = write(tmp_path / "long.mcap", 200)
    with path.open("rb") as file:
        reader = make_reader(file)
        assert len(reader.get_summary().chunk_indexes) == 200
        window = reader.iter_messages(topics=["/robot3/odom"], starting_at=150 * S, ending_before=160 * S)
        assert [message.sequence for _, _, message in window] == list(range(150, 160))
    with AnyReader([path]) as bags:
        assert sum(1 for _ in bags.messages()) == 200 * len(KEYS)


@pytest.mark.promise("P54")
def test_memory_does_not_grow_with_the_recording(tmp_path):
    writer = McapWriter(tmp_path / "r.mcap", {})
    for number in range(1, 201):
        add_chunk(writer, number)
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    for number in range(201, 1001):
        add_chunk(writer, number)
    grown = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    writer.close()
    assert grown < 150_000, "a block of 64 kB and its slack; mcap alone takes 0.9 MB"


def test_entries_stay_in_memory_while_the_disk_is_full(tmp_path, monkeypatch, small_blocks):
    def full(*_, **__):
        raise OSError(errno.ENOSPC, "No space left on device")

    writer = McapWriter(tmp_path / "r.mcap", {})
    with monkeypatch.context() as patched:
        patched.setattr(tempfile, "TemporaryFile", full)
        for number in range(1, 31):
            add_chunk(writer, number)
    for number in range(31, 61):
        add_chunk(writer, number)
    writer.close()
    with (tmp_path / "r.mcap").open("rb") as file:
        assert len(make_reader(file).get_summary().chunk_indexes) == 60


def test_without_its_index_the_file_is_read_from_front_to_back(tmp_path, monkeypatch, small_blocks):
    def broken(_):
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr(ChunkIndexSpool, "_read", broken)
    path = write(tmp_path / "r.mcap", 50)
    with path.open("rb") as file:
        assert sum(1 for _ in make_reader(file).iter_messages()) == 50 * len(KEYS)
    assert sum(1 for _ in open_recording(path).messages()) == 50 * len(KEYS)
