"""Ends of recordings: a damaged index or footer is reported and replaced, and a second recording behind it is read."""

import struct

import pytest
from mcap.reader import make_reader
from mcap.writer import IndexType, Writer

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.recordings.copying import copy
from tailor.runtime.recordings.mcap.scan import MAGIC
from tailor.runtime.recordings.mcap.writer import McapWriter
from tailor.runtime.recordings.recording import open_recording
from tailor.tools.main import main
from tests.unit.runtime.recordings.test_mcap_writer import S, chunk_bounds, odometry, write_tape

FOOTER_BYTES = 29
SCHEMA = b"nav_msgs/msg/Odometry"


def summary_start(data):
    return struct.unpack_from("<Q", data, len(data) - len(MAGIC) - FOOTER_BYTES + 9)[0]


def flipped(path, at):
    data = bytearray(path.read_bytes())
    data[at] ^= 0x10
    path.write_bytes(data)
    return path


def spoilt(path, part):
    """A recording whose summary or footer has one flipped bit."""
    data = write_tape(path).read_bytes()
    start = summary_start(data)
    places = {
        "definition of a schema": data.index(SCHEMA, start) + 200,
        "length of a record": start + 8,
        "index of a chunk": len(data) - len(MAGIC) - FOOTER_BYTES - 150,
        "start of the summary": len(data) - len(MAGIC) - FOOTER_BYTES + 9,
        "checksum": len(data) - len(MAGIC) - 1,
    }
    return flipped(path, places[part])


PARTS = ["definition of a schema", "length of a record", "index of a chunk", "start of the summary", "checksum"]


@pytest.mark.parametrize("part", PARTS)
def test_a_damaged_index_costs_no_message_and_is_reported_and_recovered(tmp_path, part):
    """Foxglove and rosbag2 trust the index; a definition in it once passed for a changed one of ours."""
    path = spoilt(tmp_path / "bad.mcap", part)
    recording = open_recording(path)
    assert [m.sequence for m in recording.messages()] == list(range(1, 51))
    assert recording.damage.text()
    assert main(["recover", str(path), "-o", str(tmp_path / "new.mcap")]) == 0
    with (tmp_path / "new.mcap").open("rb") as file:
        assert sum(1 for _ in make_reader(file, validate_crcs=True).iter_messages()) == 50


def test_a_damaged_index_is_named(tmp_path):
    recording = open_recording(spoilt(tmp_path / "bad.mcap", "index of a chunk"))
    assert len(list(recording.messages())) == 50
    assert recording.damage.text() == "5 chunks intact, 0 damaged, 8 bytes lost (its index or footer is damaged)"


def test_a_chunk_that_passes_for_the_end_of_the_data_costs_its_own_messages_only(tmp_path):
    """It ended the file without a word."""
    path = write_tape(tmp_path / "bad.mcap")
    data = bytearray(path.read_bytes())
    start, _ = list(chunk_bounds(data))[1]
    data[start - 9] = 0x0F
    path.write_bytes(data)
    recording = open_recording(path)
    assert [m.sequence for m in recording.messages()] == [*range(1, 11), *range(21, 51)]
    assert "bytes lost" in recording.damage.text()


def both(path, first, second):
    path.write_bytes(first.read_bytes() + second.read_bytes())
    return path


def test_a_recording_that_is_appended_to_another_is_read_too_and_named(tmp_path):
    """The second one was ignored without a word, and `recover` found nothing to recover."""
    first = write_tape(tmp_path / "a.mcap")
    second = write_tape(tmp_path / "b.mcap", count=20)
    recording = open_recording(both(tmp_path / "ab.mcap", first, second))
    assert [m.sequence for m in recording.messages()] == [*range(1, 51), *range(1, 21)]
    assert f"another recording begins at byte {first.stat().st_size}" in recording.damage.text()


def test_a_recording_without_an_index_that_is_appended_to_another_is_named_too(tmp_path):
    """Its footer points nowhere, so nothing seemed to be wrong; other readers end at the first footer."""
    bare = tmp_path / "b.mcap"
    with bare.open("wb") as file:
        kinds = {"repeat_channels": False, "repeat_schemas": False, "use_statistics": False}
        writer = Writer(file, index_types=IndexType.NONE, use_summary_offsets=False, **kinds)
        writer.start()
        writer.add_message(writer.register_channel("/x", "json", 0), 1, b"{}", 1)
        writer.finish()
    assert open_recording(bare).metadata() == []
    path = both(tmp_path / "ab.mcap", write_tape(tmp_path / "a.mcap"), bare)
    recording = open_recording(path)
    assert len(list(recording.messages())) == 51
    assert "another recording begins at byte" in recording.damage.text()
    assert main(["recover", str(path), "-o", str(tmp_path / "new.mcap")]) == 0
    assert len(list(open_recording(tmp_path / "new.mcap").messages())) == 51


def test_a_copy_of_appended_recordings_keeps_the_senders_of_both(tmp_path):
    """Both number their channels from one on."""
    senders = ("ab" * 16, "cd" * 16)
    for name, sender in zip("ab", senders, strict=True):
        writer = McapWriter(tmp_path / f"{name}.mcap", {})
        writer.write(odometry(1, attachment=pack(Origin(1, 501, sender))), S)
        writer.close()
    path = both(tmp_path / "ab.mcap", tmp_path / "a.mcap", tmp_path / "b.mcap")
    copy(path, tmp_path / "new.mcap", lambda *_: True, {})
    assert [m.sender for m in open_recording(tmp_path / "new.mcap").messages()] == list(senders)


def test_a_file_of_magic_bytes_alone_is_read_at_once(tmp_path):
    (tmp_path / "bad.mcap").write_bytes(MAGIC * 300_000)
    recording = open_recording(tmp_path / "bad.mcap")
    assert list(recording.messages()) == []
    assert not recording.damage.complete
