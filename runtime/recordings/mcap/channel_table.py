"""Channels of one MCAP file: one for each key, type and sender, within limits that no flood of ids exceeds.

MCAP numbers channels with 16 bits, and each takes memory until the file is closed.
"""

from __future__ import annotations

from collections import Counter
from typing import Any

from tailor.runtime.bus.encoding import named_type
from tailor.runtime.bus.inbox import Raw
from tailor.schemas.ros2.profiles import topic_at
from tailor.schemas.typesystem import definition, ros_type, type_hash, type_of

MAX_SENDERS = 100  # of one key and type; a restart of a process is a new sender
MAX_KEYS = 500  # a robot has about 30
MAX_CHANNELS = 10_000  # of single senders; with one shared channel for each key and type, below 2**16
MIXED = f"senders beyond the first {MAX_SENDERS} of this key, mixed"


class ChannelTable:
    """Registers channels with mcap's Writer when their first message comes."""

    def __init__(self, writer: Any) -> None:
        self.mixed: Counter[str] = Counter()  # messages in shared channels, by key
        self._writer = writer
        self._schemas: dict[str, int] = {"": 0}  # type of another project: no schema
        self._keys: set[str] = set()
        self._senders: Counter[tuple[str, str]] = Counter()  # number of them, by key and type
        self._channels: dict[tuple[str, str, str], int] = {}  # by key, type and sender
        self._shared: dict[tuple[str, str], int] = {}  # by key and type

    def channel(self, raw: Raw, sender: str) -> int | None:
        """Id of the channel of a message; None if it would need a key beyond MAX_KEYS.

        Senders beyond MAX_SENDERS of a key share one channel, whose metadata names no sender.
        """
        kind = _type_name(raw)
        channel = self._channels.get((raw.key, kind, sender))
        if channel is not None:
            return channel
        if raw.key not in self._keys:
            if len(self._keys) >= MAX_KEYS:
                return None
            self._keys.add(raw.key)
        if self._senders[raw.key, kind] < MAX_SENDERS and len(self._channels) < MAX_CHANNELS:
            self._senders[raw.key, kind] += 1
            channel = self._channels[raw.key, kind, sender] = self._register(raw.key, kind, {"sender": sender})
            return channel
        self.mixed[raw.key] += 1
        if (raw.key, kind) not in self._shared:
            self._shared[raw.key, kind] = self._register(raw.key, kind, {"sender": "", "mixed": MIXED})
        return self._shared[raw.key, kind]

    def _register(self, key: str, kind: str, entries: dict[str, str]) -> int:
        known: type | None = type_of(kind)
        hashed = {"type_hash": type_hash(known)} if known is not None else {}
        return int(
            self._writer.register_channel(f"/{key}", "cdr", self._schema(kind), {"key": key, **entries, **hashed})
        )

    def _schema(self, kind: str) -> int:
        known: type | None = type_of(kind)
        if kind not in self._schemas and known is not None:
            self._schemas[kind] = self._writer.register_schema(kind, "ros2msg", definition(known).encode())
        return self._schemas[kind]


def _type_name(raw: Raw) -> str:
    """ROS type that a message names, or that of its key if it names none; empty for types of other projects."""
    name = named_type(raw.encoding)
    if not name and (topic := topic_at(raw.key)) is not None:
        name = ros_type(topic.type)
    return name if type_of(name) else ""
