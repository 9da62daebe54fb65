"""The arm domain: interface of the PowerCube arm and its letters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from tailor.executive.domains.arm import belief as believing
from tailor.executive.domains.arm import predicates
from tailor.executive.domains.arm.action_library import ACTIONS, EXECUTABLES
from tailor.executive.domains.arm.belief import ArmBelief
from tailor.executive.domains.arm.robot import ANGLE_MAX_RAD, JOINTS, V_MAX_RADPS
from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.domain import Axis, LabelQuery, Scenario
from tailor.executive.interfaces.values import Fact, Interval
from tailor.schemas.messages import JointCommand, JointState, Message, Sample

BEYOND_RAD = 1.6 * ANGLE_MAX_RAD  # an arm that was pushed past its ends comes back; a turn too much reads 4.28 or more


@dataclass(frozen=True, slots=True)
class ArmDomain:
    """See tailor.executive.interfaces.domain.Domain."""

    pddl: str
    name: str = "arm"
    robot: str = "powercube"
    actions: Mapping[str, Action] = field(default_factory=lambda: ACTIONS)
    executables: Mapping[str, str] = field(default_factory=lambda: EXECUTABLES)
    axes: tuple[Axis, ...] = tuple(Axis(joint, "rad/s", -V_MAX_RADPS, V_MAX_RADPS) for joint in JOINTS)
    command_topic: str = "joint_cmd"
    sensors: tuple[str, ...] = ("joint_states",)
    required: tuple[str, ...] = ("joint_states",)
    belief_names: tuple[str, ...] = ("a (rad)", "wa (rad/s)", "b (rad)", "wb (rad/s)")

    def initial_belief(self) -> ArmBelief:
        """The belief before the first encoder reading."""
        return ArmBelief()

    def update(
        self, belief: ArmBelief, now_ns: int, samples: tuple[Sample, ...], command: tuple[float, ...]
    ) -> ArmBelief:
        """Estimate the joint state from encoders and the last command."""
        return believing.update(belief, now_ns, samples, command)

    def ready(self, belief: ArmBelief) -> bool:
        """Whether an encoder reading has been received."""
        return belief.seen_ns is not None

    def measurement_fault(self, belief: ArmBelief, message: Message) -> str:
        """Why a joint state is no measurement: the ends of the writing joints stop them."""
        if not isinstance(message, JointState):
            return ""
        rows = ((n, a) for n, a in zip(message.names, message.positions, strict=False) if n in JOINTS)
        return next((f"has {n} at {a:.3g} rad, beyond its end" for n, a in rows if abs(a) > BEYOND_RAD), "")

    def relocations(self, belief: ArmBelief) -> int:
        """How often the joints were found where they cannot have moved to."""
        return belief.relocated

    def belief_values(self, belief: ArmBelief) -> tuple[float, ...]:
        """As named in `belief_names`."""
        return tuple(predicates.named(belief.angles, belief.velocities).values())

    def anchor(self, belief: ArmBelief, scenario: Scenario, remembered: frozenset[Fact]) -> frozenset[Fact]:
        """The remembered abstract state: strokes on the page cannot be observed."""
        return remembered

    def value(self, query: LabelQuery) -> Interval | None:
        """Range of a joint state's quantity at a waypoint, see arm.predicates."""
        return predicates.value(query)

    def message(self, command: tuple[float, ...], stamp_ns: int) -> Message:
        """Joint velocities; the driver closes the current loop."""
        return JointCommand(stamp_ns, JOINTS, command)
