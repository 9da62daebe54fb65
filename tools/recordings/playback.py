"""Which messages of a recording a replay sends, and under which keys."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from tailor.runtime.bus.publisher import Publisher
from tailor.runtime.bus.session import Session
from tailor.runtime.recordings.recording import Recorded, Recording
from tailor.runtime.recordings.selection import Selection
from tailor.schemas.errors import UsageError


def _same(recorded: Recorded) -> Recorded:
    return recorded


NOTHING_BARRED = Selection()


@dataclass(frozen=True, slots=True)
class Passage:
    """A part of a recording."""

    recording: Recording
    wanted: Selection
    remap: Mapping[str, str] = field(default_factory=dict)  # old key -> new key
    start_s: float = 0.0  # after the recording's first message, wanted or not
    duration_s: float = 0.0  # 0: to the end
    barred: Selection = NOTHING_BARRED  # new keys that are left out all the same
    rewrite: Callable[[Recorded], Recorded] = _same

    def messages(self) -> Iterator[Recorded]:
        """The messages, in file order."""
        start_ns, end_ns = self.bounds_ns()
        start_ns = start_ns if self.start_s else 0  # what comes first need not be earliest
        for recorded in self.recording.messages():
            if start_ns <= recorded.log_ns < end_ns and self.wanted.wants(recorded.key, recorded.ros_type):
                key = self.remap.get(recorded.key, recorded.key)
                if self.barred.allows(key):
                    yield self.rewrite(replace(recorded, key=key))

    def bounds_ns(self) -> tuple[int, int]:
        """Log times of the passage, the second one exclusive.

        Raises:
          UsageError: The recording is empty.
        """
        first = next(self.recording.messages(), None)
        if first is None:
            raise UsageError(f"{self.recording.path}: holds no message")
        start_ns = first.log_ns + round(self.start_s * 1e9)
        return start_ns, start_ns + round(self.duration_s * 1e9) if self.duration_s else 2**63

    def places(self) -> set[tuple[str, str]]:
        """Keys and ROS types that it will publish.

        Raises:
          UsageError: Nothing is left to play.
        """
        places = {(recorded.key, recorded.ros_type) for recorded in self.messages()}
        if not places:
            raise UsageError(f"{self.recording.path}: no message of these topics and times, expected something to play")
        return places


class Outlets:
    """A publisher for each key and type of a passage, declared before the first message."""

    def __init__(self, session: Session, places: set[tuple[str, str]]) -> None:
        self._publishers = {place: session.player(*place) for place in sorted(places)}

    def __call__(self, key: str, ros_type: str) -> Publisher:
        """The publisher for a key and a type."""
        return self._publishers[key, ros_type]

    def wait(self, timeout_s: float) -> list[str]:
        """Wait until somebody listens to every key; those that nobody listens to after `timeout_s`."""
        ends = time.monotonic() + timeout_s
        while True:
            deaf = sorted({key for (key, _), outlet in self._publishers.items() if not outlet.matched()})
            if not deaf or time.monotonic() >= ends:
                return deaf
            time.sleep(0.02)


def remapping(words: Sequence[str]) -> dict[str, str]:
    """OLD=NEW words as a table.

    Raises:
      UsageError: A word of another form.
    """
    pairs = [word.split("=") for word in words]
    for word, pair in zip(words, pairs, strict=True):
        if len(pair) != 2 or not all(pair):
            raise UsageError(f"--remap {word}: expected OLD=NEW, e.g. agilo/odom=ghost/odom")
    return {pair[0]: pair[1] for pair in pairs}
