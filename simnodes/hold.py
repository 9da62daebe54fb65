"""Dead man's switches: whoever publishes an e-stop of false promises to repeat it; silence is a release.

Standard library alone; pure. The times are the driver's own monotonic clock in real time, also where a simulator
freezes the guard's clock: people hold a switch in real time.
"""

from __future__ import annotations

from collections import Counter

from tailor.simnodes.reasons import HoldRefusal

RELEASED_NS = 500_000_000  # silence that counts as a release; a switch repeats at 10 Hz
MAX_HELD = 32


class HeldSwitches:
    """The dead man's switches that people hold.

    Attributes:
      refused: Number of messages that were not counted on, by reason.
    """

    def __init__(self) -> None:
        """Nobody holds one."""
        self.refused: Counter[HoldRefusal] = Counter()
        self._held: dict[str, tuple[int, int]] = {}  # sender -> (arrival, sequence) of its newest message

    @property
    def senders(self) -> tuple[str, ...]:
        """Senders that hold a switch, sorted."""
        return tuple(sorted(self._held))

    def hold(self, sender: str, sequence: int, arrival_ns: int) -> None:
        """Note that a switch is held; a message on which the driver does not count is counted as refused.

        Args:
          sender: Its sender, 32 hex digits; empty: unsigned.
          sequence: Number of the message, counted by the sender; 0: not numbered.
          arrival_ns: Monotonic time of its arrival.
        """
        refusal = self._refusal(sender, sequence)
        if refusal is None:
            self._held[sender] = (arrival_ns, sequence)
        else:
            self.refused[refusal] += 1

    def released(self, now_ns: int) -> tuple[str, ...]:
        """Senders that have been silent for too long; they are forgotten."""
        silent = tuple(sorted(s for s, (at_ns, _) in self._held.items() if now_ns - at_ns > RELEASED_NS))
        for sender in silent:
            del self._held[sender]
        return silent

    def forget(self) -> None:
        """Count on no switch until its next message."""
        self._held.clear()

    def _refusal(self, sender: str, sequence: int) -> HoldRefusal | None:
        if sender not in self._held:
            return HoldRefusal.TOO_MANY if len(self._held) >= MAX_HELD else None
        if sequence and sequence <= self._held[sender][1]:
            return HoldRefusal.OLD_SEQUENCE  # a recorded message must not stand for a hand on the switch
        return None
