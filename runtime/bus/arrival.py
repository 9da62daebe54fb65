"""When a sample arrived, on the receiver's monotonic clock, though it is only looked at once a tick.

A ring handler does not say when it was filled. Our publishers ask the receiver's zenoh to note the wall time of
reception (in Rust, no Python thread involved); its distance to now is the sample's age. A sample without that note
gets the time of the drain. Senders' own stamps play no part: nobody can make data fresher than it is.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Instant:
    """The two clocks read at one moment."""

    monotonic_ns: int
    wall_ns: int


def arrival_ns(received_wall_ns: int | None, previous: Instant, now: Instant) -> int:
    """Monotonic arrival time of a sample that was found at `now` and not yet there at the drain before, `previous`.

    A jump of the wall clock between reception and drain cannot move the result out of [previous, now].
    """
    if received_wall_ns is None:
        return now.monotonic_ns
    age_ns = now.wall_ns - received_wall_ns
    return min(max(now.monotonic_ns - age_ns, previous.monotonic_ns), now.monotonic_ns)
