"""The soccer domain: interface of the AGILO robot and its tasks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from tailor.executive.domains.soccer import balls, implausible, opponents, predicates
from tailor.executive.domains.soccer import belief as believing
from tailor.executive.domains.soccer.action_library import ACTIONS, EXECUTABLES
from tailor.executive.domains.soccer.belief import SoccerBelief
from tailor.executive.domains.soccer.robot import OMEGA_MAX_RADPS, V_MAX_MPS
from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.domain import Axis, LabelQuery, Scenario
from tailor.executive.interfaces.values import Fact, Interval
from tailor.schemas.messages import Message, Sample, VelocityCommand


@dataclass(frozen=True, slots=True)
class SoccerDomain:
    """See tailor.executive.interfaces.domain.Domain."""

    pddl: str
    name: str = "soccer"
    robot: str = "agilo"
    actions: Mapping[str, Action] = field(default_factory=lambda: ACTIONS)
    executables: Mapping[str, str] = field(default_factory=lambda: EXECUTABLES)
    axes: tuple[Axis, ...] = (
        Axis("v", "m/s", -V_MAX_MPS, V_MAX_MPS),
        Axis("omega", "rad/s", -OMEGA_MAX_RADPS, OMEGA_MAX_RADPS),
    )
    command_topic: str = "cmd_vel"
    sensors: tuple[str, ...] = ("odom", "pose", "ball", "opponents", "ball2")
    required: tuple[str, ...] = ("odom", "pose")
    belief_names: tuple[str, ...] = (
        "x (m)",
        "y (m)",
        "phi (rad)",
        "v (m/s)",
        "omega (rad/s)",
        "ball_x (m)",
        "ball_y (m)",
        "pose_sigma (m)",
        "ball_sigma (m)",
        *opponents.NAMES,
        *balls.NAMES,
    )

    def initial_belief(self) -> SoccerBelief:
        """The belief before the first percept."""
        return believing.unknown()

    def update(
        self, belief: SoccerBelief, now_ns: int, samples: tuple[Sample, ...], command: tuple[float, ...]
    ) -> SoccerBelief:
        """Filter odometry, poses and percepts of balls and opponents; the command is not used."""
        return believing.update(belief, now_ns, samples, self.robot)

    def ready(self, belief: SoccerBelief) -> bool:
        """Whether the pose has settled, the ball was looked for long enough, and opponents were looked for lately."""
        return believing.ready(belief)

    def measurement_fault(self, belief: SoccerBelief, message: Message) -> str:
        """Why a message of a sensor is no measurement, see soccer.implausible."""
        return implausible.fault(message)

    def relocations(self, belief: SoccerBelief) -> int:
        """How often the robot was moved by others."""
        return belief.relocated

    def belief_values(self, belief: SoccerBelief) -> tuple[float, ...]:
        """Values of `belief_names`, those of opponents and of a second ball once there are any.

        A ball never seen is at the origin with a standard deviation of -1.
        """
        pose = belief.pose
        ball_x, ball_y = belief.ball_xy or (0.0, 0.0)
        ball_sigma = belief.ball.variance**0.5 if belief.ball is not None else -1.0
        pose_sigma = max(0.0, 0.5 * (pose.covariance[0] + pose.covariance[3])) ** 0.5
        second = balls.values(belief)
        opposed = opponents.values(belief.opponents, padded=bool(second))
        own = pose.x, pose.y, pose.phi, belief.v, belief.omega
        return *own, ball_x, ball_y, pose_sigma, ball_sigma, *opposed, *second

    def anchor(self, belief: SoccerBelief, scenario: Scenario, remembered: frozenset[Fact]) -> frozenset[Fact]:
        """The abstract state of now, see soccer.predicates."""
        return predicates.anchor(belief, scenario, remembered)

    def value(self, query: LabelQuery) -> Interval | None:
        """Range of a quantity of a place, see soccer.predicates."""
        return predicates.value(query)

    def message(self, command: tuple[float, ...], stamp_ns: int) -> Message:
        """Translational and rotational velocity."""
        return VelocityCommand(stamp_ns, command[0], command[1])
