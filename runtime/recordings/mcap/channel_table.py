"""Channels of one MCAP file: one for each key, type and sender, within limits that no flood of ids exceeds.

MCAP numbers channels with 16 bits, and each takes memory until the file is closed.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from functools import partial
from typing import Any

from tailor.runtime.bus.encoding import named_type
from tailor.runtime.bus.inbox import Raw
from tailor.schemas.ros2.profiles import topic_at
from tailor.schemas.typesystem import definition, ros_type, type_hash, type_of

MAX_SENDERS = 100  # of one key and type; a restart of a process is a new sender
MAX_KEYS = 500  # a robot has about 30
MAX_CHANNELS = 10_000  # of single senders
MAX_SHARED = 50_000  # shared channels, one for each key and type; all together below 2**16
MIXED = f"senders beyond the first {MAX_SENDERS} of this key, mixed"


@dataclass(frozen=True, slots=True)
class Declaration:
    """A channel as its file declares it."""

    number: int  # in the file
    topic: str
    encoding: str  # of its messages
    schema: tuple[str, str, bytes] | None  # name, encoding, data
    metadata: tuple[tuple[str, str], ...]


class ChannelTable:
    """Registers channels with mcap's Writer when their first message comes."""

    def __init__(self, writer: Any) -> None:
        self.mixed: Counter[str] = Counter()  # messages in shared channels, by key
        self._writer = writer
        self._schemas: dict[tuple[str, str, bytes], int] = {}
        self._keys: set[str] = set()
        self._senders: Counter[tuple[str, Hashable]] = Counter()  # number of them, by key and type
        self._channels: dict[tuple[str, Hashable, Hashable], int] = {}  # by key, type and sender
        self._shared: dict[tuple[str, Hashable], int] = {}  # by key and type

    def channel(self, raw: Raw, sender: str) -> int | None:
        """Id of the channel of a message; None if it would need a key beyond MAX_KEYS, or one beyond MAX_SHARED.

        Senders beyond MAX_SENDERS of a key share one channel, whose metadata names no sender.
        """
        kind = _type_name(raw)
        named = raw.key, kind, sender
        known = self._channels.get(named)
        return self._new(*named, partial(_declaration, *named)) if known is None else known

    def copied(self, key: str, declared: Declaration) -> int | None:
        """Id of the channel of a message of another file, declared as there, within the limits of `channel`."""
        kind = (declared.encoding, declared.schema)
        known = self._channels.get((key, kind, declared))
        return self._new(key, kind, declared, lambda: declared) if known is None else known

    def _new(self, key: str, kind: Hashable, sender: Hashable, declare: Callable[[], Declaration]) -> int | None:
        """Id of the channel of a sender that has none of its own yet; mixed ones come here with each message."""
        if key not in self._keys:
            if len(self._keys) >= MAX_KEYS:
                return None
            self._keys.add(key)
        if self._senders[key, kind] < MAX_SENDERS and len(self._channels) < MAX_CHANNELS:
            self._senders[key, kind] += 1
            channel = self._channels[key, kind, sender] = self._register(declare(), {})
            return channel
        shared = self._shared.get((key, kind))
        if shared is None:
            if len(self._shared) >= MAX_SHARED:
                return None
            mixed = {"key": key, "sender": "", "mixed": MIXED}
            shared = self._shared[key, kind] = self._register(declare(), mixed)
        self.mixed[key] += 1
        return shared

    def _register(self, declared: Declaration, changes: dict[str, str]) -> int:
        schema = 0 if declared.schema is None else self._schema(declared.schema)
        entries = {**dict(declared.metadata), **changes}
        return int(self._writer.register_channel(declared.topic, declared.encoding, schema, entries))

    def _schema(self, schema: tuple[str, str, bytes]) -> int:
        if schema not in self._schemas:
            self._schemas[schema] = self._writer.register_schema(*schema)
        return self._schemas[schema]


def _declaration(key: str, kind: str, sender: str) -> Declaration:
    """Channel of our own; a type of another project has no schema."""
    known: type | None = type_of(kind)
    entries = (("key", key), ("sender", sender))
    if known is None:
        return Declaration(0, f"/{key}", "cdr", None, entries)
    schema = (kind, "ros2msg", definition(known).encode())
    return Declaration(0, f"/{key}", "cdr", schema, (*entries, ("type_hash", type_hash(known))))


def _type_name(raw: Raw) -> str:
    """ROS type that a message names, or that of its key if it names none; empty for types of other projects."""
    name = named_type(raw.encoding)
    if not name and (topic := topic_at(raw.key)) is not None:
        name = ros_type(topic.type)
    return name if type_of(name) else ""
