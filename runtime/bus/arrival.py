"""Arrival time of a sample on the receiver's monotonic clock, although samples are drained only once a tick.

zenoh's ring buffer does not record when it was filled. Our publishers request a reception stamp, which the receiver's
zenoh adds in Rust. The age of the stamp gives the arrival time; without a stamp it is the time of the drain. Stamps of
the sender are ignored: no sender can make data look fresher than it is.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Instant:
    """Readings of both clocks at the same moment."""

    monotonic_ns: int
    wall_ns: int


def arrival_ns(received_wall_ns: int | None, previous: Instant, now: Instant) -> int:
    """Monotonic arrival time of a sample that arrived between the drains at `previous` and `now`.

    A jump of the wall clock cannot move the result out of [previous, now].

    Args:
      received_wall_ns: Wall time of reception, Unix nanoseconds; None if unknown.
      previous: Time of the previous drain.
      now: Time of this drain.
    """
    if received_wall_ns is None:
        return now.monotonic_ns
    age_ns = now.wall_ns - received_wall_ns
    return min(max(now.monotonic_ns - age_ns, previous.monotonic_ns), now.monotonic_ns)
