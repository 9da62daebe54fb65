"""Discs in the way, for tests of actions with a context: the belief is their rows, success is the clearance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.action_context import ActionContext, ContextColumn
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.instantiation import believed_contexts
from tailor.executive.refinement.objective.sequence import ActionSequence
from tests.support.synthetic_models import APPROACH, DRIBBLE, GO, MODELS, sequence

Disc = tuple[float, float, float]  # x, y, radius in m


@dataclass
class ClearanceSuccess:
    """Success on the straight way past one disc; 0.5 where the way is 0.1 m off its edge."""

    calls: int = 0

    def probability(self, arguments: Array) -> Array:
        self.calls += 1
        start, goal, place, radius = arguments[:, :2], arguments[:, 4:6], arguments[:, 8:10], arguments[:, 10]
        way = goal - start
        share = ((place - start) * way).sum(axis=1) / np.maximum((way * way).sum(axis=1), 1e-9)
        nearest = start + np.clip(share, 0, 1)[:, None] * way
        return 1 / (1 + np.exp(-40 * (np.hypot(*(place - nearest).T) - radius - 0.1)))


def discs(belief: Sequence[Disc]) -> Array:
    return np.array(belief, dtype=np.float64).reshape(-1, 3)


CONTEXT = ActionContext(
    (
        ContextColumn("obstacle_x", "m", -3.5, 3.5, tolerance=0.1),
        ContextColumn("obstacle_y", "m", -2.25, 2.25, tolerance=0.1),
        ContextColumn("obstacle_r", "m", 0.05, 0.3),
    ),
    discs,
    "goToPose/clearance",
    "obstacle",
)
GO_AROUND = replace(GO, context=CONTEXT, subgoal_action="goToPose")
APPROACH_AROUND = replace(APPROACH, context=CONTEXT)
LIBRARY = {action.name: action for action in (GO_AROUND, APPROACH_AROUND, DRIBBLE)}
BESIDE = Models(MODELS.durations, {**MODELS.successes, "goToPose/clearance": ClearanceSuccess()})


def beside(belief: Sequence[Disc], actions: Sequence[Action], places: Sequence[dict]) -> ActionSequence:
    """Actions from place to place, instantiated from a belief as the pattern does it."""
    plain = sequence(list(actions), list(places))
    contexts = believed_contexts(LIBRARY, belief)
    instances = tuple(replace(a, context=contexts.get(a.action.name, ())) for a in plain.actions)
    return replace(plain, actions=instances, library=LIBRARY, contexts=contexts)
