"""Compares where poses show that a robot has moved to with the distance that its odometry reports.

Odometry that reports less, such as 0 m/s from a broken encoder, is no measurement: with it a drive ended at 0.45 m/s.
One that reports more may be true, of wheels that slip.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from tailor.schemas.messages import Message, Odometry, PoseEstimate

HALF_NS = 500_000_000  # both halves of a second must contradict, so that no single jump of a pose does
KEPT_NS = 1_400_000_000  # poses until then; a localiser may pause for a tick or two
SLIP, MARGIN_M = 1.3, 0.1  # of the reported distance, and beside it
SIGMAS = 4.0  # of both poses' noise
LEVER_M = 0.5  # a pose so far from the axle moves while the robot turns


@dataclass(frozen=True, slots=True)
class Fix:
    """A pose, and the distance that odometry has reported until then."""

    at_ns: int
    x: float  # m
    y: float  # m
    variance: float  # m², of x and y
    reported_m: float


@dataclass(frozen=True, slots=True)
class Travel:
    """Poses of the last second, and what odometry has reported."""

    fixes: tuple[Fix, ...] = ()
    at_ns: int | None = None  # arrival of the last odometry; None: none yet
    speed_mps: float = 0.0  # of the robot and of a pose beside its axle
    reported_m: float = 0.0


def travelled(travel: Travel, at_ns: int, message: Message) -> tuple[Travel, str]:
    """What is known after a message, and why it is no measurement.

    Args:
      travel: What was known before it.
      at_ns: Its arrival.
      message: Odometry, or a pose; others change nothing.

    Returns:
      What is known, and the fault of odometry, e.g. "has v at 0 while poses move at 0.45 m/s"; empty if it has none.
    """
    if isinstance(message, PoseEstimate):
        return _with_pose(travel, at_ns, message), ""
    if not isinstance(message, Odometry):
        return travel, ""
    travel = _with_odometry(travel, at_ns, message)
    speed_mps = _unreported_mps(travel, at_ns)
    return travel, f"has v at {message.v:.2g} while poses move at {speed_mps:.2g} m/s" if speed_mps else ""


def _with_odometry(travel: Travel, at_ns: int, odometry: Odometry) -> Travel:
    speed = abs(odometry.v) + LEVER_M * abs(odometry.omega)
    reported_m = travel.reported_m + max(speed, travel.speed_mps) * _passed_s(travel, at_ns)
    return replace(travel, at_ns=at_ns, speed_mps=speed, reported_m=reported_m)


def _with_pose(travel: Travel, at_ns: int, pose: PoseEstimate) -> Travel:
    reported_m = travel.reported_m + travel.speed_mps * _passed_s(travel, at_ns)
    fix = Fix(at_ns, pose.x, pose.y, max(0.0, pose.var_x, pose.var_y), reported_m)
    return replace(travel, fixes=(*(f for f in travel.fixes if at_ns - f.at_ns <= KEPT_NS), fix))


def _unreported_mps(travel: Travel, at_ns: int) -> float:
    """Speed of the poses over the last second if odometry reports less in both of its halves; 0 otherwise."""
    fixes = _ends(travel)
    if len(fixes) < 3 or at_ns - fixes[-1].at_ns > HALF_NS:
        return 0.0
    first, middle, last = fixes
    onward = (middle.x - first.x) * (last.x - middle.x) + (middle.y - first.y) * (last.y - middle.y)
    if onward <= 0.0 or not (_exceeds(first, middle) and _exceeds(middle, last)):
        return 0.0
    return math.dist((first.x, first.y), (last.x, last.y)) / (1e-9 * (last.at_ns - first.at_ns))


def _ends(travel: Travel) -> tuple[Fix, ...]:
    """The poses at the ends of two halves of a second; fewer if there are none so old."""
    ends: list[Fix] = []
    for fix in reversed(travel.fixes):
        if not ends or ends[-1].at_ns - fix.at_ns >= HALF_NS:
            ends.append(fix)
    return tuple(reversed(ends[:3]))


def _exceeds(before: Fix, after: Fix) -> bool:
    """Whether the robot has moved farther than odometry reports, and all noise."""
    moved_m = math.hypot(after.x - before.x, after.y - before.y)
    noise_m = SIGMAS * math.sqrt(before.variance + after.variance)
    return moved_m > SLIP * (after.reported_m - before.reported_m) + MARGIN_M + noise_m


def _passed_s(travel: Travel, at_ns: int) -> float:
    return 1e-9 * max(0, at_ns - travel.at_ns) if travel.at_ns is not None else 0.0
