"""Refuses goals that may have waited since before people were told that nobody responds. Pure.

They wait in this process while it stands still, and in the router while that does. The bus misses a silent process from
0.75 s on, and a silent router as soon; it may still deliver, when both go on, what it was given before.
"""

from __future__ import annotations

STOOD_NS = 600_000_000  # without a tick
SILENT_NS = 700_000_000  # without a message of the robot
LOST_NS = 2_000_000_000  # a bus that is silent for longer has lost its requests with its sessions: the robot is silent
LATE_NS = 1_000_000_000  # after that: until then, goals arrive that were sent before
AGAIN = "send the goal again if it holds"


class LateGoals:
    """Follows the ticks of an executive, and what they hear."""

    def __init__(self) -> None:
        self._heard_ns: int | None = None  # nothing yet: a bus without a robot on it is silent, too
        self._until_ns, self._why = 0, ""

    def note(self, now_ns: int, stood_ns: int, arrived_ns: int | None) -> None:
        """Take a tick.

        Args:
          now_ns: Time after its look at goals.
          stood_ns: For how long the executive stood still before it.
          arrived_ns: Arrival of the newest message of the robot since the tick before; None without any.
        """
        silent_ns = 0 if self._heard_ns is None else now_ns - self._heard_ns
        if stood_ns >= STOOD_NS:
            self._until_ns, self._why = now_ns + LATE_NS, f"the executive stood still for {1e-9 * stood_ns:.1f} s"
        elif SILENT_NS <= silent_ns < LOST_NS:
            self._until_ns, self._why = now_ns + LATE_NS, f"the bus was silent for {1e-9 * silent_ns:.1f} s"
        if arrived_ns is not None:
            self._heard_ns = arrived_ns

    def refusal(self, taken_ns: int) -> str:
        """Why a goal that this process took from the bus at that time does not count; empty: it does."""
        return f"{self._why}; {AGAIN}" if taken_ns < self._until_ns else ""
