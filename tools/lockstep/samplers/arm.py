"""Task sampler of the arm (paper 5.1): random joint states at start and goal."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tailor.executive.actions.reach import PERIOD_S
from tailor.executive.domains.arm.action_library import PASSING_RADPS, fastest_radps
from tailor.executive.domains.arm.belief import ArmBelief
from tailor.executive.domains.arm.load import COULOMB_NM, TYPICAL_RADPS, VISCOUS_NMS
from tailor.executive.domains.arm.predicates import frictions, named
from tailor.executive.domains.arm.robot import JOINTS
from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.values import Array
from tailor.schemas.messages import ActionFinished, JointState, Message
from tailor.simnodes.powercube.gear import NOMINAL_C, Gear
from tailor.simnodes.powercube.physical_parameters import PhysicalParameters
from tailor.tools.lockstep.samplers.drive_work import joint_work_j

STATE = ("a", "wa", "b", "wb")
WA, WB, WAG, WBG = 1, 3, 5, 7
A, B, AG, BG = 0, 2, 4, 6
FRICTION = slice(8, 10)
AT_REST = 0.2  # share of reaches that start at rest, and of those that end at rest: every stroke has both
ANGLE_STD_RAD, VELOCITY_STD_RADPS, FRICTION_STD = 0.0007, 0.008, 0.05  # of the belief
PARAMETERS = PhysicalParameters()
THINNEST = 0.05  # grease of a gear at 90 °C, as a multiple of the nominal viscosity: none is hotter
DISTANCE_RAD = (0.05, 2.2)  # uniform: sampling in a rectangle yields few short reaches, and words need many


@dataclass(frozen=True, slots=True)
class ArmSampler:
    """See task_sampler.TaskSampler; arguments are (a, wa, b, wb, ag, wag, bg, wbg, fa, fb)."""

    def sample(self, action: Action, rng: np.random.Generator) -> Array:
        """Arguments, shape (10,): uniform, velocities scaled to the distance, some at rest."""
        lower = np.array([p.lower for p in action.parameters])
        upper = np.array([p.upper for p in action.parameters])
        distance = rng.uniform(*DISTANCE_RAD)
        while True:
            arguments: Array = rng.uniform(lower, upper)
            direction = rng.uniform(-np.pi, np.pi)
            arguments[AG] = arguments[A] + distance * np.cos(direction)
            arguments[BG] = arguments[B] + distance * np.sin(direction)
            if np.all((lower <= arguments) & (arguments <= upper)):
                break
        arguments[[WA, WB, WAG, WBG]] *= fastest_radps(distance) / PASSING_RADPS
        for velocities in ([WA, WB], [WAG, WBG]):
            if rng.random() < AT_REST:
                arguments[velocities] = 0.0
        return arguments

    def start(self, action: Action, arguments: Array, rng: np.random.Generator) -> dict[str, float]:
        """Start state of the body, with the temperatures at which unworn gears have that friction."""
        warm = dict(zip(("ta", "tb"), map(_temperature_c, arguments[FRICTION].tolist()), strict=True))
        return dict(zip(STATE, arguments[: len(STATE)].tolist(), strict=True)) | warm

    def belief(self, start: Mapping[str, float], rng: np.random.Generator) -> ArmBelief:
        """Belief at that state, as exact as the filter leaves it; the arm has worked, and knows its friction."""
        off = rng.standard_normal((2, 2)) * ((ANGLE_STD_RAD,), (VELOCITY_STD_RADPS,))
        states = np.array(((start["a"], start["b"]), (start["wa"], start["wb"])))
        (a, b), (wa, wb) = (states + off).tolist()
        known = 1.0 + FRICTION_STD * rng.standard_normal(2)
        friction = known * [_friction(start[name]) for name in ("ta", "tb")]
        return ArmBelief(0, (a, b), (wa, wb), 0, (start["wa"], start["wb"]), friction=tuple(friction.tolist()))

    def arguments_now(self, action: Action, belief: ArmBelief, arguments: Array) -> list[float]:
        """Training example: the arguments with the believed state and friction in place of those of the start."""
        state = named(belief.angles, belief.velocities)
        return [*state.values(), *arguments[len(STATE) : FRICTION.start].tolist(), *frictions(belief.friction).values()]

    def work_j(self, before: Message, after: Message) -> float:
        """Work of the joints between two states, joules."""
        return joint_work_j(before, after)

    def failure(self, action: Action, start: Mapping[str, float], truth: Message) -> str:
        """No failure: nothing disturbs a reach in the air."""
        return ""

    def start_names(self, action: Action, parameters: Array) -> Mapping[str, str]:
        """No other names: parameters are named as the belief is."""
        return {}

    def motion(self, message: Message, newest: Message | None) -> Message | None:
        """The newest joint state."""
        return message if isinstance(message, JointState) else newest

    def observed_start(self, message: Message) -> dict[str, float] | None:
        """None: no failure depends on the start."""
        return None

    def contacts(self, finished: Sequence[ActionFinished], truth: Sequence[Message]) -> int:
        """0: there are no objects."""
        return 0

    def arrival_errors(self, action: Action, arguments: Array, truth: Message) -> Mapping[str, float]:
        """Errors of the joints' angles (rad) and velocities (rad/s); a reach ends one period before its waypoint."""
        if not isinstance(truth, JointState):
            return {}
        at = [truth.names.index(name) for name in JOINTS]
        velocities = np.array(truth.velocities)[at]
        angles = np.array(truth.positions)[at] + velocities * PERIOD_S
        return {
            "position_rad": float(np.linalg.norm(angles - arguments[[AG, BG]])),
            "speed_radps": float(np.linalg.norm(velocities - arguments[[WAG, WBG]])),
        }

    def disturbance_m(self, finished: Sequence[ActionFinished], truth: Sequence[Message]) -> float:
        """0: there are no objects."""
        return 0.0


def observed_friction(gear: Gear) -> float:
    """Friction of a gear that carries nothing as a multiple of the nominal, as the belief observes it."""
    dry_nm, viscous_nms = gear.friction(0.0)
    return (dry_nm + viscous_nms * TYPICAL_RADPS) / (COULOMB_NM + VISCOUS_NMS * TYPICAL_RADPS)


def _friction(temperature_c: float) -> float:
    """Friction of an unworn gear, see `observed_friction`."""
    gear = Gear(PARAMETERS, COULOMB_NM, VISCOUS_NMS)
    gear.temperature_c = temperature_c
    return observed_friction(gear)


def _temperature_c(friction: float) -> float:
    """The inverse of `_friction`."""
    viscous_nm = VISCOUS_NMS * TYPICAL_RADPS
    thinner = (friction * (COULOMB_NM + viscous_nm) - COULOMB_NM) / viscous_nm
    return NOMINAL_C - PARAMETERS.viscosity_fall_k * math.log(max(thinner, THINNEST))
