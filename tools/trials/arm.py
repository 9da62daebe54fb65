"""Trials of the arm's reaches (paper 5.1): random joint states, and a belief that the encoders have just told."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from executive.domains.arm.belief import ArmBelief
from executive.domains.arm.meaning import state
from executive.library import Action, Array
from schemas.messages import Message

STATE = ("a", "wa", "b", "wb")


@dataclass(frozen=True, slots=True)
class ArmTrials:
    """See tools.lockstep.Trials; controller arguments are (a, wa, b, wb, ag, wag, bg, wbg)."""

    def sample(self, action: Action, rng: np.random.Generator) -> Array:
        """Controller arguments, shape (8,), uniform over the action's ranges."""
        arguments: Array = rng.uniform([p.lower for p in action.parameters], [p.upper for p in action.parameters])
        return arguments

    def start(self, action: Action, arguments: Array) -> dict[str, float]:
        """Start state of the body."""
        return dict(zip(STATE, arguments[: len(STATE)].tolist(), strict=True))

    def belief(self, start: Mapping[str, float], rng: np.random.Generator) -> ArmBelief:
        """What the encoders say of that state."""
        return ArmBelief(0, (start["a"], start["b"]), (start["wa"], start["wb"]), 0)

    def arguments_now(self, belief: ArmBelief, arguments: Array) -> list[float]:
        """The controller arguments with the believed state in place of the start: an example to learn from."""
        return [*state(belief).values(), *arguments[len(STATE) :].tolist()]

    def failure(self, action: Action, start: Mapping[str, float], truth: Message) -> str:
        """Nothing goes wrong in the air."""
        return ""
