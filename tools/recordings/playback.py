"""Part of a recording that a replay publishes, and the publishers for it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from tailor.runtime.bus.publisher import Publisher
from tailor.runtime.bus.rights.access import may_publish
from tailor.runtime.bus.session import Session
from tailor.runtime.recordings.recording import Recorded, Recording
from tailor.runtime.recordings.selection import Selection
from tailor.schemas.errors import UsageError
from tailor.schemas.ros2.profiles import topic_at


def _unchanged(recorded: Recorded) -> Recorded:
    return recorded


ALL_KEYS = Selection()


@dataclass(frozen=True, slots=True)
class RecordingPart:
    """Messages of a recording, selected by topic and time, optionally under other keys."""

    recording: Recording
    wanted: Selection
    remap: Mapping[str, str] = field(default_factory=dict)  # old key -> new key
    start_s: float = 0.0  # after the first message of the recording, selected or not
    duration_s: float = 0.0  # 0: to the end
    excluded_keys: Selection = ALL_KEYS  # applied to the new keys
    rewrite: Callable[[Recorded], Recorded] = _unchanged
    left_out: frozenset[str] = frozenset()  # new keys

    def messages(self) -> Iterator[Recorded]:
        """Selected messages in file order."""
        start_ns, end_ns = self.bounds_ns()
        start_ns = start_ns if self.start_s else 0  # the first message need not be the earliest
        for recorded in self.recording.messages():
            if start_ns <= recorded.log_ns < end_ns and self.wanted.wants(recorded.key, recorded.ros_type):
                key = self.remap.get(recorded.key, recorded.key)
                if key not in self.left_out and self.excluded_keys.allows(key):
                    yield self.rewrite(replace(recorded, key=key))

    def bounds_ns(self) -> tuple[int, int]:
        """Log times of the part, the second one exclusive.

        Raises:
          UsageError: The recording holds no message.
        """
        first = next(self.recording.messages(), None)
        if first is None:
            raise UsageError(f"{self.recording.path}: holds no message")
        start_ns = first.log_ns + round(self.start_s * 1e9)
        return start_ns, start_ns + round(self.duration_s * 1e9) if self.duration_s else 2**63

    def channels(self) -> set[tuple[str, str]]:
        """Keys and ROS types of the selected messages.

        Raises:
          UsageError: No message is selected, or a key that is to be replaced is not in the recording.
        """
        self._check_remap()
        channels = {(recorded.key, recorded.ros_type) for recorded in self.messages()}
        if not channels:
            raise UsageError(f"{self.recording.path}: no message of these topics and times, expected at least one")
        return channels

    def playable(self) -> RecordingPart:
        """The part without what a secured bus takes from no replay; its router would drop that without a word.

        Raises:
          UsageError: Nothing is left.
        """
        keys = {key for key, _ in self.channels()}
        barred = frozenset(key for key in keys if not _may_play(key))
        if barred == keys:
            raise UsageError(
                f"{self.recording.path}: on a secured bus nobody replays {', '.join(sorted(barred))}, expected other "
                "topics, or an open bus (`tailor bus --security open`)"
            )
        return replace(self, left_out=barred)

    def _check_remap(self) -> None:
        """Raise UsageError for a misspelt key: its messages would be published under the recorded one."""
        keys: set[str] = set()
        for recorded in self.recording.messages() if self.remap else ():
            keys.add(recorded.key)
            if keys >= self.remap.keys():
                return
        if unknown := sorted(set(self.remap) - keys):
            raise UsageError(
                f"--remap {unknown[0]}={self.remap[unknown[0]]}: {self.recording.path} has no such key, expected one "
                f"of: {', '.join(sorted(keys))}"
            )


def _may_play(key: str) -> bool:
    topic = topic_at(key)
    return topic is not None and "player" in may_publish(topic)


class Publishers:
    """One publisher per key and ROS type, declared before the first message."""

    def __init__(self, session: Session, channels: set[tuple[str, str]]) -> None:
        self._publishers = {channel: session.player(*channel) for channel in sorted(channels)}

    def __call__(self, key: str, ros_type: str) -> Publisher:
        """Publisher for a key and a ROS type."""
        return self._publishers[key, ros_type]

    def wait(self, timeout_s: float) -> list[str]:
        """Wait until every key has a subscriber; returns the keys without one after `timeout_s`."""
        ends = time.monotonic() + timeout_s
        while True:
            unmatched = sorted({key for (key, _), each in self._publishers.items() if not each.matched()})
            if not unmatched or time.monotonic() >= ends:
                return unmatched
            time.sleep(0.02)


def remapping(words: Sequence[str]) -> dict[str, str]:
    """Table of OLD=NEW words: old key -> new key.

    Raises:
      UsageError: A word has another form, or a key has two new ones.
    """
    pairs = [word.split("=") for word in words]
    for word, pair in zip(words, pairs, strict=True):
        if len(pair) != 2 or not all(pair):
            raise UsageError(f"--remap {word}: expected OLD=NEW, e.g. agilo/odom=ghost/odom")
    table = {pair[0]: pair[1] for pair in pairs}
    for old, new in pairs:
        if table[old] != new:
            raise UsageError(f"--remap {old}={new}: {old} becomes {table[old]}, too, expected one new key for each")
    return table
