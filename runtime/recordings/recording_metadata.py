"""Metadata of a recording: the recorder, its clocks, and the provenance of the recorded executive."""

from __future__ import annotations

import json
from collections.abc import Mapping

from tailor.runtime.bus.attachment import sender_in
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.newest import Newest
from tailor.schemas.codec import decode
from tailor.schemas.messages import Provenance
from tailor.schemas.topics import TOPICS

CLOCKS = {
    "log_time": "wall time of reception, Unix nanoseconds",
    "publish_time": "wall time of sending by the sender's clock, Unix nanoseconds",
    "arrival": "exec/tick names inputs by key, sender and sequence, with monotonic arrival times",
}


MAX_EXECUTIVES = 32  # whose provenance is remembered


class RecordingMetadata:
    """Metadata records of a recording, name -> entries; written into each of its files."""

    def __init__(self, version: str, started_ns: int) -> None:
        """`version` is that of Tailor; `started_ns` is wall time."""
        recorder = {"version": version, "started_wall_ns": str(started_ns), "clocks": json.dumps(CLOCKS)}
        self.entries: dict[str, Mapping[str, str]] = {"recorder": recorder}
        self._provenances: Newest[str, str] = Newest(MAX_EXECUTIVES)  # of each executive, by sender

    def put(self, name: str, entries: Mapping[str, str]) -> bool:
        """Set a record; False if it is unchanged."""
        if self.entries.get(name) == entries:
            return False
        self.entries[name] = dict(entries)
        return True

    def observe(self, raw: Raw) -> bool:
        """Keep the provenance if the message contains one; True if it changed.

        Two executives would else change it twice a second, and each change is a record that no file compresses.
        """
        if raw.key != TOPICS["provenance"].key:
            return False
        message = decode(Provenance, raw.payload)
        if not isinstance(message, Provenance):
            return False
        sender = sender_in(raw.attachment)
        known = self._provenances.renew(sender, message.json)
        return message.json != known and self.put("provenance", {"sender": sender, "json": message.json})
