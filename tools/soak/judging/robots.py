"""Robots that are soaked: their topics, limits, and how fast their bodies come to rest."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tailor.schemas.messages import JointState, Message
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.simnodes.agilo import firmware
from tailor.simnodes.driver_spec import shipped_driver_spec
from tailor.simnodes.powercube.physical_parameters import WRITING, PhysicalParameters

AT_REST = 0.02  # m/s and rad/s; a body at rest reads below 0.001
MOVING = 0.1  # m/s and rad/s
TOUCHED = 0.3  # m/s and rad/s; a ball that rolls against a robot at rest jolts it by half of this
TOUCH_M = 0.4  # from the robot's centre to the ball's
BODY_TOLERANCE = 1.1  # of the limit: wheels and joints overshoot their set-points


@dataclass(frozen=True, slots=True)
class Robot:
    """A robot and its domain; all tuples follow the axes of its command."""

    name: str
    domain: str
    command: str  # topics
    truth: str
    limits: tuple[float, ...]
    decelerations: tuple[float, ...]

    def rest_s(self, speeds: tuple[float, ...]) -> float:
        """Seconds from zero at the guard to rest, at the deceleration of its own motors."""
        pairs = zip(speeds, self.decelerations, strict=True)
        return max(abs(speed) / deceleration for speed, deceleration in pairs)

    def within_limits(self, values: tuple[float, ...], tolerance: float = 1.0) -> bool:
        """Whether all values are finite and within the driver's limits; NaN is not."""
        return all(abs(value) <= limit * tolerance for value, limit in zip(values, self.limits, strict=True))


def speeds_of(truth: Message) -> tuple[float, ...] | None:
    """Speeds of a body along the axes of its command; None for any other message."""
    if isinstance(truth, SoccerGroundTruth):
        return (truth.v, truth.omega)
    if isinstance(truth, JointState):
        return truth.velocities[: len(WRITING)]
    return None


def rest_threshold(truth: Message) -> float:
    """Speed below which a body counts as at rest: higher while the ball touches it."""
    if isinstance(truth, SoccerGroundTruth) and math.dist((truth.x, truth.y), (truth.ball_x, truth.ball_y)) < TOUCH_M:
        return TOUCHED
    return AT_REST


def is_moving(speeds: tuple[float, ...], threshold: float = MOVING) -> bool:
    """Whether any axis is faster than the threshold; NaN counts as motion."""
    return not all(abs(speed) <= threshold for speed in speeds)


def _robot(name: str, domain: str, truth: str, decelerations: tuple[float, ...]) -> Robot:
    spec = shipped_driver_spec(name)
    return Robot(name, domain, spec.command_topic, truth, tuple(limit.upper for limit in spec.limits), decelerations)


_ARM_DECELERATION = PhysicalParameters().acceleration_max_radps2

ROBOTS = (
    _robot("agilo", "soccer", "truth", (firmware.SLOW_DOWN_MPS2, firmware.YAW_RADPS2)),
    _robot("powercube", "arm", "joint_truth", (_ARM_DECELERATION, _ARM_DECELERATION)),
)
