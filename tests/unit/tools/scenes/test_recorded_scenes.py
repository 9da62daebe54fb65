"""A copy with scenes is whole, or there is none."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from mcap.reader import make_reader
from mcap.writer import Writer

from tailor.runtime.recordings.mcap import channel_table
from tailor.runtime.recordings.recording import Recording
from tailor.schemas.errors import UsageError
from tailor.tools.main import main
from tailor.tools.scenes.recorded_scenes import add_scenes

GOLDEN = "tests/data/golden/soccer-approach.mcap"


def test_a_copy_that_has_no_room_for_a_key_is_refused_and_removed(monkeypatch, tmp_path):
    monkeypatch.setattr(channel_table, "MAX_KEYS", 5)
    with pytest.raises(UsageError, match=": no room for "):
        add_scenes(Path(GOLDEN), tmp_path / "scenes.mcap")
    assert not list(tmp_path.iterdir())


def test_a_recording_of_a_recorder_with_a_clock_beyond_the_bus_gets_its_scenes(monkeypatch, tmp_path):
    messages = Recording.messages
    late = {"log_ns": 2**64 - 1}  # the last moment that a recording can name
    monkeypatch.setattr(Recording, "messages", lambda self: (replace(each, **late) for each in messages(self)))
    added, *_ = add_scenes(Path(GOLDEN), tmp_path / "scenes.mcap")
    assert added > 0


def _write_foreign(path, channels=1):
    """A recording of another recorder: channels of one topic, in an encoding of their own, with a type of ROS's."""
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2", library="another")
        schema = writer.register_schema("sensor_msgs/msg/Temperature", "ros2msg", b"float64 temperature")
        for number in range(1, channels + 1):
            metadata = {"offered_qos_profiles": f"depth: {number}"}
            channel = writer.register_channel("/oven", "json", schema, metadata)
            writer.add_message(channel, 5 + number, b"{}", 3, 70_000 + number)
        plain = writer.register_channel("door", "text", 0)
        writer.add_message(plain, 900, b"open", 8, 1)
        writer.finish()


def _rows(path):
    """Of each message: schema, topic, encoding and metadata of its channel, both times, number, data."""
    rows = []
    with path.open("rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            declared = (channel.topic, channel.message_encoding, channel.metadata)
            sent = (message.log_time, message.publish_time, message.sequence, message.data)
            rows.append((schema and (schema.name, schema.encoding, schema.data), *declared, *sent))
    return rows


def test_messages_of_other_projects_keep_schema_encoding_and_metadata(tmp_path):
    source, target = tmp_path / "foreign.mcap", tmp_path / "scenes.mcap"
    _write_foreign(source)
    add_scenes(source, target)
    assert _rows(target) == _rows(source)
    assert _rows(target)[0][0] == ("sensor_msgs/msg/Temperature", "ros2msg", b"float64 temperature")


def test_a_recording_without_a_run_gets_no_copy(tmp_path, capsys):
    """The copy was the recording itself under another name, which the next attempt was refused for."""
    source = tmp_path / "foreign.mcap"
    _write_foreign(source)
    for _ in range(2):
        assert main(["scene", str(source)]) == 1
        assert capsys.readouterr().out == f"{source}: no messages to add; no file is written\n"
    assert list(tmp_path.iterdir()) == [source]


def test_channels_of_other_projects_stay_within_the_limit_of_senders(tmp_path):
    source, target = tmp_path / "foreign.mcap", tmp_path / "scenes.mcap"
    _write_foreign(source, channels=channel_table.MAX_SENDERS + 50)
    add_scenes(source, target)
    assert [row[4:] for row in _rows(target)] == [row[4:] for row in _rows(source)]
    with target.open("rb") as file:
        channels = make_reader(file).get_summary().channels.values()
    assert [each.metadata.get("mixed") for each in channels].count(channel_table.MIXED) == 1
    assert len(channels) == channel_table.MAX_SENDERS + 2


def test_a_copy_with_more_channels_than_mcap_has_numbers_for_is_refused(monkeypatch, tmp_path):
    monkeypatch.setattr(channel_table, "MAX_SENDERS", 0)
    monkeypatch.setattr(channel_table, "MAX_SHARED", 1)
    _write_foreign(tmp_path / "foreign.mcap")
    with pytest.raises(UsageError, match="no room for door"):
        add_scenes(tmp_path / "foreign.mcap", tmp_path / "scenes.mcap")
