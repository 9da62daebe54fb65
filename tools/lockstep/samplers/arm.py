"""Trials of the arm's reaches (paper 5.1): random joint states, and a belief that the encoders have just told."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tailor.executive.domains.arm.action_library import PASSING_RADPS, fastest_radps
from tailor.executive.domains.arm.belief import ArmBelief
from tailor.executive.domains.arm.predicates import named
from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.values import Array
from tailor.schemas.messages import Message
from tailor.tools.lockstep.samplers.drive_work import joint_work_j

STATE = ("a", "wa", "b", "wb")
WA, WB, WAG, WBG = 1, 3, 5, 7
A, B, AG, BG = 0, 2, 4, 6
AT_REST = 0.2  # so many reaches start at rest, and so many end at rest: every stroke has one of each
DISTANCE_RAD = (0.05, 2.2)  # evenly: drawn in a rectangle, short reaches would be few, and words are full of them


@dataclass(frozen=True, slots=True)
class ArmSampler:
    """See tailor.tools.lockstep.action_run.Trials; controller arguments are (a, wa, b, wb, ag, wag, bg, wbg)."""

    def sample(self, action: Action, rng: np.random.Generator) -> Array:
        """Controller arguments, shape (8,): all uniform, distances too, as fast as they allow; some at rest."""
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
        """Start state of the body."""
        return dict(zip(STATE, arguments[: len(STATE)].tolist(), strict=True))

    def belief(self, start: Mapping[str, float], rng: np.random.Generator) -> ArmBelief:
        """What the encoders say of that state."""
        return ArmBelief(0, (start["a"], start["b"]), (start["wa"], start["wb"]), 0)

    def arguments_now(self, action: Action, belief: ArmBelief, arguments: Array) -> list[float]:
        """The controller arguments with the believed state in place of the start: an example to learn from."""
        return [*named(belief.angles, belief.velocities).values(), *arguments[len(STATE) :].tolist()]

    def work_j(self, before: Message, after: Message) -> float:
        """Joules that the joints have taken between two states."""
        return joint_work_j(before, after)

    def failure(self, action: Action, start: Mapping[str, float], truth: Message) -> str:
        """Nothing goes wrong in the air."""
        return ""
