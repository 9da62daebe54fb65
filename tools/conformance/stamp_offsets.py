"""How far the stamps of measurements are from their arrival: what no clause can judge, but people should know.

A driver may have a clock of its own, since ages count from arrivals; so nobody can tell its offset from a delay of the
measurements, which nothing compensates.
"""

from __future__ import annotations

from collections.abc import Iterator

from tailor.tools.conformance.bench import PERIOD_S, Bench

MIN_OFFSET_S = PERIOD_S  # less is the way over the bus, or a localiser at work
MAX_OFFSET_S = 1e8  # three years: more is no wall clock that is set wrong
BEHIND = (
    "or its measurements are so late, which nothing compensates: synchronise both clocks (PTP, chrony) to see which"
)


def stamp_offsets(bench: Bench) -> Iterator[str]:
    """A line of each sensor whose freshest measurement was stamped MIN_OFFSET_S or more before or after its arrival."""
    for sensor in bench.spec.sensors:
        heard = [each for each in bench.heard(sensor.topic) if getattr(each.message, "stamp_ns", 0)]
        behind_s = min((bench.link.wall_s(each.at_s) - each.stamp_s for each in heard), default=0.0)
        if abs(behind_s) > MAX_OFFSET_S:
            yield f"{sensor.topic}: stamps are no wall time, as ROS tools expect it, but of a clock with another origin"
        elif behind_s >= MIN_OFFSET_S:
            yield f"{sensor.topic}: stamps are {behind_s:.2f} s behind their arrival: the driver's clock is, {BEHIND}"
        elif behind_s <= -MIN_OFFSET_S:
            yield f"{sensor.topic}: stamps are {-behind_s:.2f} s ahead of their arrival: the driver's clock is"
