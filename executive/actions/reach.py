"""reach: move joints to a waypoint and pass it with given velocities. Knows no letters, and counts no joints.

Arguments come as the paper's Table 6 has them: (θ, θ̇) of each joint now, then of each joint at the goal. Models
read further ones, such as friction.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from tailor.executive.actions.cubic import Cubic, Joints, best_duration_s, cubic
from tailor.executive.interfaces.action import Control
from tailor.executive.interfaces.values import Array

PERIOD_S = 0.1  # of the executive; a command stands until the next one


class JointBelief(Protocol):
    """A belief that knows its joints, and their friction as multiples of the nominal."""

    @property
    def angles(self) -> Joints: ...  # noqa: D102

    @property
    def velocities(self) -> Joints: ...  # noqa: D102

    @property
    def friction(self) -> Joints: ...  # noqa: D102


# accelerations that the joints may plan with, rad/s²: from their angles, the goal's, and their friction
Accelerations = Callable[[Joints, Joints, Joints], Joints]


@dataclass(frozen=True, slots=True)
class Motion:
    """Controller state: the motion that is followed, and the goal for which it was planned."""

    goal: Joints  # angle and velocity of each joint in turn
    cubic: Cubic
    started_ns: int
    limits: Joints  # accelerations that it was planned with


@dataclass(frozen=True, slots=True)
class Reach:
    """Follows one cubic in joint space, closed over the angles.

    A motion lasts as long as the motors need: with more friction than usual, or upward, they need longer. It makes
    another motion when the arm has strayed, or when what it meets on its way changes the time that is left by
    `reconsidered_s`; smaller differences are left alone, so that it does not dither.
    """

    accelerations: Accelerations  # what motions from rest to rest may take
    acceleration_max_radps2: float  # what no motion may exceed
    velocity_max_radps: float  # what no joint may exceed
    feedback_per_s: float = 2.0  # velocity for an error of angle
    strayed_rad: float = 0.15
    reached_rad: float = 0.05
    reached_radps: float = 0.25
    reconsidered_s: float = 0.08
    settled_s: float = 0.5  # before the waypoint the motion stands
    at_once: bool = False  # the driver reaches a velocity at once, rather than at the end of the period

    def __call__(self, state: Any, now_ns: int, belief: JointBelief, arguments: Array) -> Control:
        """See tailor.executive.interfaces.action.Controller; the command is a velocity (rad/s) for each joint.

        It is done one period before the waypoint, with the command that leads there: when the next action takes over,
        the arm is where it was to be, as fast as it was to be.
        """
        state_size = 2 * len(belief.angles)
        goal = tuple(arguments[state_size : 2 * state_size].tolist())
        motion = state if isinstance(state, Motion) and state.goal == goal else self._begin(goal, now_ns, belief)
        if self._off_rad(motion, now_ns, belief) > self.strayed_rad:
            motion = self._begin(goal, now_ns, belief)
        motion = self._reconsidered(motion, now_ns, belief)
        if not self._arrives(motion, now_ns):
            return Control(motion, self._command(motion, now_ns, belief))
        if self._is_near(motion, now_ns, belief):
            return Control(motion, self._command(motion, now_ns, belief), "done")
        motion = self._begin(goal, now_ns, belief)
        return Control(motion, self._command(motion, now_ns, belief))

    def _begin(self, goal: Joints, now_ns: int, belief: JointBelief) -> Motion:
        """A motion from where the arm is; it takes whole periods, so that the waypoint falls on a tick."""
        angles, velocities = goal[0::2], goal[1::2]
        states = (belief.angles, belief.velocities, angles, velocities)
        limits = self.accelerations(belief.angles, angles, belief.friction)
        periods = max(1, round(best_duration_s(*states, limits) / PERIOD_S))
        longest = 2 * periods  # ends that are too fast themselves are no reason to take longer
        motion = cubic(*states, periods * PERIOD_S)
        while self._exceeds(motion) and periods < longest:
            periods += 1
            motion = cubic(*states, periods * PERIOD_S)
        return Motion(goal, motion, now_ns, limits)

    def _exceeds(self, motion: Cubic) -> bool:
        return motion.peak_acceleration > self.acceleration_max_radps2 or motion.peak_velocity > self.velocity_max_radps

    def _reconsidered(self, motion: Motion, now_ns: int, belief: JointBelief) -> Motion:
        left_s = motion.cubic.duration_s - _elapsed_s(motion, now_ns)
        if left_s < self.settled_s or motion.started_ns == now_ns:
            return motion
        states = (belief.angles, belief.velocities, motion.goal[0::2], motion.goal[1::2])
        limits = self.accelerations(belief.angles, motion.goal[0::2], belief.friction)
        change_s = best_duration_s(*states, limits) - best_duration_s(*states, motion.limits)
        return self._begin(motion.goal, now_ns, belief) if abs(change_s) > self.reconsidered_s else motion

    def _off_rad(self, motion: Motion, now_ns: int, belief: JointBelief) -> float:
        """How far the arm is from where the motion has it."""
        return math.dist(motion.cubic.angles(_elapsed_s(motion, now_ns)), belief.angles)

    def _arrives(self, motion: Motion, now_ns: int) -> bool:
        """Whether the waypoint comes within this period, rather than in the next."""
        return _elapsed_s(motion, now_ns) > motion.cubic.duration_s - 1.5 * PERIOD_S

    def _is_near(self, motion: Motion, now_ns: int, belief: JointBelief) -> bool:
        wanted = motion.cubic.velocities(_elapsed_s(motion, now_ns))
        slow_enough = math.dist(wanted, belief.velocities) < self.reached_radps
        return slow_enough and self._off_rad(motion, now_ns, belief) < self.reached_rad

    def _command(self, motion: Motion, now_ns: int, belief: JointBelief) -> Joints:
        """Velocity at the end of this period, when the driver will have got there, and what corrects the angles.

        Of a driver that gets there at once: the mean velocity of this period.
        """
        t = _elapsed_s(motion, now_ns)
        velocities = motion.cubic.velocities(t + (0.5 if self.at_once else 1.0) * PERIOD_S)
        wanted = zip(velocities, motion.cubic.angles(t), belief.angles, strict=True)
        return tuple(velocity + self.feedback_per_s * (angle - is_at) for velocity, angle, is_at in wanted)


def _elapsed_s(motion: Motion, now_ns: int) -> float:
    return (now_ns - motion.started_ns) * 1e-9
