"""The ground partial plan: steps, orderings, causal links and flaws. Immutable; shares lists with its parent.

Terms as in Younes & Simmons, JAIR 20 (2003), section 2. Flaws are singly linked lists, the newest at the head.
"""

from __future__ import annotations

from typing import NamedTuple

from tailor.executive.planning.ground.ground_action import GroundAction, Span
from tailor.executive.planning.ground.ground_formula import GroundCondition
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.ground_plans.step_effects import StepEffects, no_masks
from tailor.executive.planning.structures.orderings import FIRST, GOAL, Orderings

new = tuple.__new__  # makes a named tuple from a plain one in half the time of its constructor


class Link(NamedTuple):
    """A causal link: `producer` makes `literal` true, and no step may undo it until `last`.

    The condition belongs to the node `first`; `last` differs from it only for a condition over all of an action.
    """

    producer: int
    literal: int
    first: int
    last: int
    rest: Link | None


class OpenCondition(NamedTuple):
    """A condition of node `first`, to hold until `last`, that no causal link supports yet."""

    condition: GroundCondition
    first: int
    last: int
    rest: OpenCondition | None


class Threat(NamedTuple):
    """Node `node` may undo `link` between its producer and its consumer, if `conditions` of that effect hold."""

    link: Link
    node: int
    conditions: tuple[tuple[GroundCondition, Span], ...]
    rest: Threat | None


Flaw = OpenCondition | Threat


class PartialPlan(NamedTuple):
    """Represents all plans with these steps, orderings and links. Step i is `steps[i - 1]`."""

    steps: tuple[GroundAction, ...]
    orderings: Orderings
    effects: StepEffects
    links: Link | None
    open: OpenCondition | None
    threats: Threat | None
    open_count: int
    threat_count: int
    cost: float


def initial_plan(task: GroundTask) -> PartialPlan:
    """The plan without steps whose open conditions are the goal, the first at the head."""
    masks = no_masks(len(task.names))
    for number, (literal, _) in enumerate(task.timed):
        masks[literal] |= 1 << FIRST + number
    cell: OpenCondition | None = None
    for condition in reversed(task.goal):
        cell = OpenCondition(condition, GOAL, GOAL, cell)
    return PartialPlan((), task.initial_orderings(), StepEffects(masks), None, cell, None, len(task.goal), 0, 0)
