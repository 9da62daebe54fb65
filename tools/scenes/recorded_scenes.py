"""Gives a recording the markers and transforms of its run: a copy with `scene`, `sim/scene` and `tf` added."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.encoding import encoding_of
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.recordings.copying import utf8_name
from tailor.runtime.recordings.mcap.channel_table import MAX_KEYS
from tailor.runtime.recordings.mcap.scan import DamageReport
from tailor.runtime.recordings.mcap.writer import McapWriter
from tailor.runtime.recordings.new_file import new_file
from tailor.runtime.recordings.recording import LATEST_NS, Recording, open_recording
from tailor.schemas.codec import encode
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import FrameTransforms, LogLine, Message, SceneShapes
from tailor.schemas.topics import key_of
from tailor.schemas.typesystem import ros_type
from tailor.tools.scenes.scene_feed import SceneFeed

DERIVED = tuple(ros_type(kind) for kind in (SceneShapes, FrameTransforms, LogLine))
SENDER = "5c" * 16


def add_scenes(source: Path, target: Path) -> tuple[int, SceneFeed, DamageReport]:
    """Copy a recording and add the scenes of its run; markers, transforms and log in it are replaced.

    Returns:
      Number of messages added, the feed that made them, and the damage of the source, which the copy's metadata states.

    Raises:
      UsageError: The source is no recording, or the target exists, or it cannot be written or has too many keys and is
        removed.
    """
    recording, feed, added = open_recording(source), SceneFeed(), Counter[str]()
    metadata = {name: entries for name, entries in recording.metadata() if name != "topics"}
    with new_file(target):
        writer = McapWriter(target, metadata)
        try:
            _write(writer, recording, feed, added)
            if text := recording.damage.text():
                writer.add_metadata("copy", {"of": utf8_name(source), "damage": text})
        finally:
            whole = writer.close()
        if not whole:
            raise UsageError(f"{target}: {writer.disk_error}")
    return added.total(), feed, recording.damage


def _write(writer: McapWriter, recording: Recording, feed: SceneFeed, added: Counter[str]) -> None:
    """Copy the messages and add those of the feed; `added` counts the latter by key."""
    for recorded in recording.messages():
        if recorded.ros_type in DERIVED:
            continue
        sent = (recorded.log_ns, recorded.data, recorded.publish_ns, recorded.sequence)
        _check(writer.copy(recorded.key, recorded.declared, sent), writer, recorded.key)
        message = recorded.value() if feed.wants(recorded.key) else None
        made = feed.messages_after(recorded.log_ns / 1e9, recorded.key, message) if isinstance(message, Message) else []
        for topic, each in made:
            key = key_of(topic, feed.robot)
            added[key] += 1
            origin = pack(Origin(added[key], min(recorded.log_ns, LATEST_NS), SENDER))
            raw = Raw(key, encode(each), origin, encoding_of(type(each)), True, None)
            _check(writer.write(raw, recorded.log_ns), writer, key)
        if writer.is_full and not writer.flush():
            raise UsageError(f"{writer.path}: {writer.disk_error}")


def _check(written: bool, writer: McapWriter, key: str) -> None:
    if not written:
        raise UsageError(f"{writer.path}: no room for {key}, expected at most {MAX_KEYS} keys, scenes included")
