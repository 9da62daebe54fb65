"""Joins the commands of several outlets: those of one sender with one sequence number are one command.

So one guard judges all axes together: a part that is missing, late or refused lets no other part pass.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

MAX_WAITING = 8  # incomplete commands; the parts of one arrive together, so more are lost or forged


@dataclass(frozen=True, slots=True)
class Part:
    """The command of one outlet."""

    outlet: int  # index
    sequence: int
    values: tuple[float, ...]
    stamp_ns: int  # 0: unknown


@dataclass(frozen=True, slots=True)
class Joined:
    """Set-points of all axes, or none for a command that stays incomplete: the guard refuses and counts it."""

    sequence: int
    values: tuple[float, ...] = ()
    stamp_ns: int = 0


@dataclass(slots=True)
class CommandParts:
    """Parts that wait for the others; of one sender at a time.

    Attributes:
      widths: Number of axes of each outlet.
    """

    widths: Sequence[int]
    _sender: str = ""
    _waiting: dict[int, dict[int, Part]] = field(default_factory=dict)  # by sequence number, oldest arrival first

    def join(self, part: Part, sender: str, armed_sender: str) -> list[Joined]:
        """Commands for the guard, in order, once a part has arrived.

        Args:
          part: The part.
          sender: Its sender.
          armed_sender: Sender that the guard obeys; parts of others are passed on for refusal at once.
        """
        if len(self.widths) == 1:
            return [Joined(part.sequence, part.values, part.stamp_ns)]
        if sender != armed_sender:
            return [Joined(part.sequence)]
        if sender != self._sender:
            self._sender, self._waiting = sender, {}
        parts = self._waiting.setdefault(part.sequence, {})
        if part.outlet in parts:
            return [Joined(part.sequence)]  # the first one counts: a second one is a replay
        parts[part.outlet] = part
        if len(parts) < len(self.widths):
            return self._dropped(len(self._waiting) - MAX_WAITING)
        older = [sequence for sequence in self._waiting if sequence < part.sequence]
        dropped = [Joined(sequence) for sequence in older]
        for sequence in (*older, part.sequence):
            del self._waiting[sequence]
        return [*dropped, self._joined(part.sequence, parts)]

    def forget(self) -> None:
        """Let no part wait any more."""
        self._waiting = {}

    def _dropped(self, count: int) -> list[Joined]:
        oldest = list(self._waiting)[: max(0, count)]
        for sequence in oldest:
            del self._waiting[sequence]
        return [Joined(sequence) for sequence in oldest]

    def _joined(self, sequence: int, parts: dict[int, Part]) -> Joined:
        ordered = [parts[outlet] for outlet in range(len(self.widths))]
        if any(len(part.values) != width for part, width in zip(ordered, self.widths, strict=True)):
            return Joined(sequence)
        values = tuple(value for part in ordered for value in part.values)
        return Joined(sequence, values, min(part.stamp_ns for part in ordered))
