"""Hostile recordings: every command that reads one ends soon, with a result or one clear line."""

import json
import os
import struct
from dataclasses import replace
from pathlib import Path

import pytest
from mcap.writer import Writer

from tailor.executive.composition import rebuild_context
from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.recordings import copying
from tailor.runtime.recordings.mcap import declared, scan
from tailor.runtime.recordings.mcap.scan import MAGIC
from tailor.runtime.recordings.recording import open_recording
from tailor.runtime.recordings.selection import Selection
from tailor.schemas.codec import decode, encode
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import Provenance
from tailor.schemas.topics import TOPICS
from tailor.tools.main import main
from tailor.tools.recordings import recorded_run
from tailor.tools.recordings.playback import RecordingPart
from tailor.tools.recordings.recorded_run import RecordedRuns
from tailor.tools.recordings.survey import survey
from tests.support.bus_system import bus_system
from tests.support.cpu_time import standard_cpu_s
from tests.unit.runtime.recordings.test_mcap_writer import chunk_bounds, write_tape


def copied(path):
    return copying.copy(path, path.with_name("new.mcap"), lambda *_: True, {})


NOTHING = Selection(("no/such/key",))
GOLDEN = Path(__file__).parents[3] / "data" / "golden" / "soccer-approach.mcap"


def foreign(path, rows=((10, "x"),), metadata=()):
    """A recording that another program made; rows of log time and topic."""
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2", library="other")
        schema = writer.register_schema("std_msgs/msg/Bool", "ros2msg", b"bool data")
        for log_ns, topic in rows:
            channel = writer.register_channel(topic, "cdr", schema, {})
            writer.add_message(channel, log_ns, b"\0\1\0\0\1", log_ns)
        for name, entries in metadata:
            writer.add_metadata(name, entries)
        writer.finish()
    return path


@pytest.mark.parametrize(
    "metadata",
    [
        ("drops", {"odom": "many"}),
        ("drops", {"odom": "9" * 5000}),
        ("provenance", {"json": "[" * 100_000}),
        ("provenance", {"json": "[1, 2]"}),
        ("provenance", {"json": '{"a": NaN, "b": 1e999}'}),
    ],
)
def test_info_accepts_any_metadata(tmp_path, capsys, metadata):
    path = foreign(tmp_path / "a.mcap", metadata=[metadata])
    assert main(["info", str(path)]) == int(metadata[0] == "drops")
    assert main(["info", "--json", str(path)]) == int(metadata[0] == "drops")
    summary = json.loads(capsys.readouterr().out.splitlines()[-1], parse_constant=pytest.fail)
    assert summary["messages"] == 1


def test_info_escapes_control_characters_and_markup_of_topics(tmp_path, capsys):
    assert main(["info", str(foreign(tmp_path / "a.mcap", [(1, "[/bold]"), (2, "[red]\x1b[31m")]))]) == 0
    output = capsys.readouterr().out
    assert "[/bold]" in output
    assert "[red]\\x1b[31m" in output
    assert "\x1b" not in output


def test_info_of_thousands_of_topics_ends_soon(tmp_path, capsys):
    path = foreign(tmp_path / "a.mcap", [(k, f"t{k}") for k in range(5000)])
    codes = []
    assert standard_cpu_s(lambda: codes.append(main(["info", str(path)]))) < 5.0
    assert set(codes) == {0}
    assert "and 4500 topics more" in capsys.readouterr().out


def test_a_recording_without_order_lasts_from_its_earliest_message_and_is_cut_and_replayed_whole(tmp_path, capsys):
    path = foreign(tmp_path / "a.mcap", [(5_000_000_000, "x"), (2_000_000_000, "x"), (9_000_000_000, "x")])
    assert survey(open_recording(path)).span_ns == (2_000_000_000, 9_000_000_000)
    assert main(["cut", str(path), "-o", str(tmp_path / "b.mcap")]) == 0
    assert len(list(open_recording(tmp_path / "b.mcap").messages())) == 3


@pytest.mark.parametrize("damage", ["length", "opcode", "hole", "size of a chunk"])
def test_messages_after_a_damaged_record_are_recovered(tmp_path, damage):
    data = bytearray(write_tape(tmp_path / "a.mcap").read_bytes())
    start, end = list(chunk_bounds(data))[1]
    if damage == "length":
        data[start - 2] = 0x7F
    elif damage == "opcode":
        data[start - 9] = 0
    elif damage == "size of a chunk":
        (name_bytes,) = struct.unpack_from("<I", data, start + 28)
        data[start + 32 + name_bytes + 7] ^= 0x80  # one bit: 2^63 bytes more
    else:
        data[start - 9 : end] = bytes(end - start + 9)
    (tmp_path / "bad.mcap").write_bytes(data)
    recording = open_recording(tmp_path / "bad.mcap")
    assert [m.sequence for m in recording.messages()] == [*range(1, 11), *range(21, 51)]
    assert "bytes lost" in recording.damage.text()


def test_a_copy_of_more_channels_than_a_file_may_have_leaves_messages_out(tmp_path, monkeypatch):
    monkeypatch.setattr(copying, "MAX_CHANNELS", 2)
    foreign(tmp_path / "a.mcap", rows=[(10 * k, f"topic{k}") for k in range(9)])
    copied = copying.copy(tmp_path / "a.mcap", tmp_path / "b.mcap", lambda *_: True, {})
    assert (copied.kept, copied.left_out) == (2, 7)
    assert len(list(open_recording(tmp_path / "b.mcap").messages())) == 2


@pytest.mark.promise("P40")
@pytest.mark.parametrize("read", [lambda path: list(open_recording(path).messages()), copied])
@pytest.mark.parametrize("kind", ["schemas", "channels"])
def test_declarations_that_unpack_to_more_than_fits_into_memory_are_refused(tmp_path, monkeypatch, kind, read):
    """A file of 84 kB unpacked to 1.8 GB of schemas, or of channels' metadata, all of which were kept."""
    monkeypatch.setattr(declared, "MAX_BYTES", 100_000)
    path = tmp_path / "a.mcap"
    with path.open("wb") as file:
        writer = Writer(file, repeat_schemas=False, repeat_channels=False)
        writer.start(profile="ros2", library="other")
        for n in range(200):
            data, entries = (b"x" * 1000, {}) if kind == "schemas" else (b"", {"x": "x" * 1000})
            schema = writer.register_schema(f"a/msg/B{n}", "ros2msg", data)
            writer.add_message(writer.register_channel(f"t{n}", "cdr", schema, entries), 10, b"", 10)
        writer.finish()
    with pytest.raises(UsageError, match="more than 100000 bytes of schemas and channels"):
        read(path)
    assert not path.with_name("new.mcap").exists()


def test_declarations_that_each_chunk_repeats_count_once(tmp_path, monkeypatch):
    monkeypatch.setattr(declared, "MAX_BYTES", 10_000)
    path = write_tape(tmp_path / "a.mcap", count=50, chunks=50)
    path.write_bytes(path.read_bytes() * 20)
    assert len(list(open_recording(path).messages())) == 1000


def test_the_reason_of_a_damaged_chunk_is_never_empty(tmp_path):
    """It was, where an error has no text: mcap's at the end of the data."""
    path = tmp_path / "a.mcap"
    path.write_bytes(MAGIC + struct.pack("<BQ", 0x06, 40) + bytes(28) + struct.pack("<I", 9) + bytes(8))
    recording = open_recording(path)
    assert list(recording.messages()) == []
    assert "a chunk is damaged: EndOfFile" in recording.damage.text()


def test_the_report_of_a_file_of_nothing_but_damage_stays_small(tmp_path):
    with (tmp_path / "bad.mcap").open("wb") as file:
        file.write(MAGIC + struct.pack("<BQ2s", 0x03, 2, b"xx") * 10_000)
    recording = open_recording(tmp_path / "bad.mcap")
    assert list(recording.messages()) == []
    assert len(recording.damage.reasons) == 3


@pytest.mark.parametrize("opcode", [0x03, 0x06, 0x0C])
def test_a_file_with_a_hole_of_200_mb_is_read_at_once(tmp_path, opcode):
    path = tmp_path / "sparse.mcap"
    with path.open("wb") as file:
        file.write(MAGIC + struct.pack("<BQ", opcode, 50_000_000))
        file.truncate(200_000_000)
    read = []
    assert standard_cpu_s(lambda: read.append(list(open_recording(path).messages()))) < 1.0
    assert read == [[]] * len(read)


def test_a_hole_is_passed_without_looking_for_a_chunk_at_every_byte(tmp_path, monkeypatch):
    monkeypatch.setattr(scan, "_START", None)
    path = tmp_path / "sparse.mcap"
    path.write_bytes(MAGIC + bytes(3 * scan.WINDOW_BYTES))
    assert list(open_recording(path).messages()) == []


def test_a_pipe_is_refused_instead_of_waited_for(tmp_path, monkeypatch):
    """Every command that reads a recording stood still, without a word."""
    monkeypatch.setattr(Path, "open", lambda path, mode: pytest.fail("it is opened"))
    os.mkfifo(tmp_path / "a.mcap")
    with pytest.raises(UsageError, match=r"a\.mcap: is a pipe, expected a recording in a file"):
        open_recording(tmp_path / "a.mcap")


def test_recover_returns_1_if_nothing_could_be_recovered(tmp_path, capsys):
    path = tmp_path / "torn.mcap"
    path.write_bytes(write_tape(tmp_path / "a.mcap").read_bytes()[:200])
    assert main(["recover", str(path)]) == 1
    assert "0 messages recovered" in capsys.readouterr().out


def test_an_empty_name_for_a_new_file_is_refused(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = write_tape(tmp_path / "a.mcap")
    (tmp_path / "torn.mcap").write_bytes(path.read_bytes()[:-40])
    for command in (["cut", "a.mcap"], ["recover", "torn.mcap"]):
        assert main([*command, "-o", ""]) == 2
        assert "expected the name of a new file" in capsys.readouterr().err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.mcap", "torn.mcap"]


# --- provenance ----------------------------------------------------------------------------------
def with_provenance(monkeypatch, text):
    """The golden run with this text as its provenance; None: without provenance."""
    whole = open_recording(GOLDEN)
    messages = [m for m in whole.messages() if text is not None or m.key != TOPICS["provenance"].key]
    for n, message in enumerate(messages):
        if message.key == TOPICS["provenance"].key:
            provenance = decode(Provenance, message.data)
            messages[n] = replace(message, data=encode(replace(provenance, json=text)))
    monkeypatch.setattr(whole, "messages", lambda: iter(messages), raising=False)
    monkeypatch.setattr(recorded_run, "open_recording", lambda path: whole)


@pytest.mark.parametrize("text", ["", "{", "[]", "null", "[" * 100_000, "{}", '{"config": 5}', None])
def test_a_run_without_valid_provenance_is_refused_in_one_line(monkeypatch, text):
    with_provenance(monkeypatch, text)
    with pytest.raises(UsageError, match="provenance"):
        rebuild_context(RecordedRuns(GOLDEN).runs[0].provenance)


@pytest.mark.promise("P40")
@pytest.mark.parametrize("name", ["config", "sender", "stamp_offset_ns", "models", "machine", "required"])
@pytest.mark.parametrize("value", [None, "x", 1.5, []])
def test_every_part_of_a_provenance_is_checked(name, value):
    provenance = RecordedRuns(GOLDEN).runs[0].provenance
    if name == "sender" and value == "x":
        return
    with pytest.raises(UsageError, match=name):
        rebuild_context({**provenance, name: value})


@pytest.mark.parametrize("rate", [None, "x", True, -1, float("nan"), 10**400])
def test_a_rate_of_a_provenance_that_is_no_rate_is_refused(rate):
    provenance = RecordedRuns(GOLDEN).runs[0].provenance
    with pytest.raises(UsageError, match="required"):
        rebuild_context({**provenance, "required": {"agilo/odom": rate}})


def test_the_error_for_a_file_without_a_run_includes_its_damage(tmp_path, capsys):
    path = tmp_path / "torn.mcap"
    path.write_bytes(GOLDEN.read_bytes()[:10_000])
    assert main(["verify", str(path)]) == 2
    assert "no footer" in capsys.readouterr().err


@pytest.mark.promise("P40")
def test_a_run_that_unpacks_to_more_than_fits_into_memory_is_refused(monkeypatch):
    """A recording of 0.2 MB can hold 2.5 GB of zeros."""
    monkeypatch.setattr(recorded_run, "MAX_BYTES", 10_000)
    with pytest.raises(UsageError, match="more than 10000 bytes of messages"):
        RecordedRuns(GOLDEN)


def test_a_run_of_very_many_empty_messages_is_refused(tmp_path, monkeypatch):
    """They count as much as they take: 40 kB can hold millions of messages without data, 0.1 kB of memory each."""
    path = foreign(tmp_path / "a.mcap", [(k, "x") for k in range(1000)])
    monkeypatch.setattr(recorded_run, "MAX_BYTES", 100_000)
    with pytest.raises(UsageError, match="more than 100000 bytes of messages"):
        RecordedRuns(path)


# --- replay --------------------------------------------------------------------------------------
def test_a_malformed_sender_counts_as_unsigned(tmp_path):
    path = tmp_path / "a.mcap"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2", library="other")
        for n, sender in enumerate(("zz", "ab", "g" * 32, "é" * 16, "ab" * 16)):
            channel = writer.register_channel(f"x{n}", "cdr", 0, {"sender": sender})
            writer.add_message(channel, 10, b"", 2**64 - 1)
        writer.finish()
    found = list(open_recording(path).messages())
    assert [m.sender for m in found] == ["", "", "", "", "ab" * 16]
    for message in found:
        pack(Origin(message.sequence, message.publish_ns, message.sender or "00" * 16))


def test_an_empty_selection_is_an_error_instead_of_an_endless_loop(tmp_path):
    path = foreign(tmp_path / "a.mcap")
    for part in (
        RecordingPart(open_recording(path), Selection(), start_s=99.0),
        RecordingPart(open_recording(path), NOTHING),
    ):
        with pytest.raises(UsageError, match="expected at least one"):
            part.channels()


def test_a_key_with_two_new_ones_is_refused(tmp_path, capsys):
    """The last one counted, without a word."""
    path = str(foreign(tmp_path / "a.mcap"))
    assert main(["replay", path, "--remap", "x=y", "--remap", "x=z", "--connect", "tcp/127.0.0.1:9"]) == 2
    assert "--remap x=y: x becomes z, too, expected one new key for each" in capsys.readouterr().err


def test_excluded_keys_are_excluded_after_remapping_as_well(tmp_path):
    recording = open_recording(foreign(tmp_path / "a.mcap", [(1, "x"), (2, "y")]))
    part = RecordingPart(recording, Selection(), {"x": "agilo/cmd_vel"}, excluded_keys=Selection(exclude=("cmd_vel",)))
    assert [m.key for m in part.messages()] == ["y"]


def test_a_type_whose_name_the_bus_cannot_carry_is_not_played():
    """zenoh panics in the put, which ended the replay with a traceback of Rust's."""
    with bus_system() as (session, _, _):
        session.player("a/b", "a" * 239).publish_encoded(b"")
        with pytest.raises(UsageError, match=r"type 'a+…', expected a name that the bus can carry"):
            session.player("a/b", "a" * 240)


@pytest.mark.parametrize("key", ["", "/", "a/", "**", "agilo/*", "a#b", "x" * 70_000])
def test_an_invalid_key_or_pattern_is_not_played(key):
    with bus_system() as (session, _, _), pytest.raises(UsageError, match="expected one that the bus can carry"):
        session.player(key, "std_msgs/msg/Bool")
