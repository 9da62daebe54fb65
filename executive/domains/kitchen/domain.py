"""The kitchen domain: interface of the B21 and its tasks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from tailor.executive.domains.kitchen import abstract_state, implausible, predicates, robot
from tailor.executive.domains.kitchen import belief as believing
from tailor.executive.domains.kitchen.action_library import ACTIONS, EXECUTABLES
from tailor.executive.domains.kitchen.belief import KitchenBelief
from tailor.executive.domains.kitchen.known_places import cup_place, table_place
from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.domain import Axis, LabelQuery, Scenario
from tailor.executive.interfaces.outlet import Outlet
from tailor.executive.interfaces.values import Fact, Interval
from tailor.schemas.kitchen.kinematics import GRIPPER_MAX_M, JOINT_MAX_RADPS, JOINTS, OMEGA_MAX_RADPS, V_MAX_MPS
from tailor.schemas.messages import JointCommand, Message, Sample, VelocityCommand
from tailor.schemas.messages.kitchen import GripperCommand

BASE = (Axis("v", "m/s", -V_MAX_MPS, V_MAX_MPS), Axis("omega", "rad/s", -OMEGA_MAX_RADPS, OMEGA_MAX_RADPS))
ARM = tuple(Axis(joint, "rad/s", -JOINT_MAX_RADPS, JOINT_MAX_RADPS) for joint in JOINTS)
GRIPPER = (Axis("width", "m", 0.0, GRIPPER_MAX_M, kept=0.0),)  # it may hold a cup when the executive starts
CUPS = 3  # that telemetry has room for


def _drive(command: tuple[float, ...], stamp_ns: int) -> Message:
    return VelocityCommand(stamp_ns, command[0], command[1])


def _move(command: tuple[float, ...], stamp_ns: int) -> Message:
    return JointCommand(stamp_ns, JOINTS, command)


def _close(command: tuple[float, ...], stamp_ns: int) -> Message:
    return GripperCommand(stamp_ns, command[0])


@dataclass(frozen=True, slots=True)
class KitchenDomain:
    """See tailor.executive.interfaces.domain.Domain."""

    pddl: str
    name: str = "kitchen"
    robot: str = "b21"
    actions: Mapping[str, Action] = field(default_factory=lambda: ACTIONS)
    executables: Mapping[str, str] = field(default_factory=lambda: EXECUTABLES)
    axes: tuple[Axis, ...] = (*BASE, *ARM, *GRIPPER)
    outlets: tuple[Outlet, ...] = (
        Outlet("base", "cmd_vel", BASE, _drive),
        Outlet("arm", "joint_cmd", ARM, _move),
        Outlet("gripper", "gripper_cmd", GRIPPER, _close),
    )
    command_topic: str = "cmd_vel"
    sensors: tuple[str, ...] = ("odom", "pose", "joint_states", "gripper", "objects")
    required: tuple[str, ...] = ("odom", "pose", "joint_states", "gripper", "objects")
    belief_names: tuple[str, ...] = (
        "x (m)",
        "y (m)",
        "phi (rad)",
        "v (m/s)",
        "omega (rad/s)",
        *(f"{joint} (rad)" for joint in JOINTS),
        "width (m)",
        *(f"table{k}_{quantity}" for k in (1, 2, 3) for quantity in ("x (m)", "y (m)", "phi (rad)")),
        *(f"cup{k}_{axis} (m)" for k in range(1, CUPS + 1) for axis in "xyz"),
    )

    def initial_belief(self) -> KitchenBelief:
        """The belief before the first percept."""
        return KitchenBelief()

    def update(
        self, belief: KitchenBelief, now_ns: int, samples: tuple[Sample, ...], command: tuple[float, ...]
    ) -> KitchenBelief:
        """Filter odometry, poses, joints, gripper and percepts of objects; the command is not used."""
        return believing.update(belief, now_ns, samples)

    def ready(self, belief: KitchenBelief) -> bool:
        """Whether the pose has settled and the arm is known."""
        return believing.ready(belief)

    def relocations(self, belief: KitchenBelief) -> int:
        """How often base or arm were moved by others."""
        return belief.relocated

    def kept(self, belief: KitchenBelief) -> tuple[float, ...]:
        """Set-points at which the gripper stays as wide as it is, and goes on pressing what is in it."""
        return (*(0.0,) * (len(BASE) + len(ARM)), robot.kept_width(belief.width, belief.force))

    def measurement_fault(self, belief: KitchenBelief, message: Message) -> str:
        """Why a message is no measurement, see kitchen.implausible."""
        return implausible.fault(belief, message)

    def belief_values(self, belief: KitchenBelief) -> tuple[float, ...]:
        """Values of `belief_names`; tables and cups not seen yet are where the map has them, last cups are left out."""
        pose = belief.pose
        tables = (value for k in (1, 2, 3) for value in table_place(belief, f"table{k}"))
        seen = [k for k in range(1, CUPS + 1) if belief.thing(f"cup{k}") is not None]
        cups = (value for k in range(1, max(seen, default=0) + 1) for value in cup_place(belief, f"cup{k}"))
        return (pose.x, pose.y, pose.phi, belief.v, belief.omega, *belief.angles, belief.width, *tables, *cups)

    def anchor(self, belief: KitchenBelief, scenario: Scenario, remembered: frozenset[Fact]) -> frozenset[Fact]:
        """The abstract state of now, see kitchen.abstract_state."""
        return abstract_state.anchor(belief, scenario, remembered)

    def value(self, query: LabelQuery) -> Interval | None:
        """Range of a quantity of a place, see kitchen.predicates."""
        return predicates.value(query)

    def message(self, command: tuple[float, ...], stamp_ns: int) -> Message:
        """Velocities of the base, the first outlet."""
        return _drive(command, stamp_ns)
