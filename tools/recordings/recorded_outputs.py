"""Recorded outputs of an executive on one topic, matched with those of today's core by their sequence numbers."""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum

from tailor.runtime.recordings.recording import Recorded


class Absent(Enum):
    """Why nothing is recorded of an output."""

    LOST = "lost"  # the number of a later one shows that it was published
    NONE = "none"


class RecordedOutputs:
    """Messages of one key in the order of their numbers, which begin at 1; a bridge to DDS has none, thus 0.

    Attributes:
      lost: Number of outputs that were published and are not recorded.
    """

    def __init__(self, messages: Sequence[Recorded], ends_early: bool = False) -> None:
        """`ends_early`: whatever follows the last message is lost, too."""
        self.lost = 0
        self._messages, self._ends_early = messages, ends_early
        self._at = self._number = 0  # messages taken, outputs of today

    def take(self, ends_here: bool = False) -> Recorded | Absent:
        """What is recorded of today's next output; `ends_here`: the recording may end just before it."""
        self._number += 1
        following = self.following
        if following is None and not (self._ends_early or ends_here):
            return Absent.NONE
        if following is None or following.sequence > self._number:
            self.lost += 1
            return Absent.LOST
        self._at += 1
        return following

    @property
    def following(self) -> Recorded | None:
        """The first message that is not taken yet; None at the end."""
        return self._messages[self._at] if self._at < len(self._messages) else None

    @property
    def taken(self) -> int:
        """Number of messages that were taken."""
        return self._at


def before_gap(messages: Sequence[Recorded]) -> Sequence[Recorded]:
    """The messages before the first number that is missing."""
    gaps = (at for at, message in enumerate(messages) if message.sequence > at + 1)
    return messages[: next(gaps, len(messages))]
