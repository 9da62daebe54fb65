"""Ground actions and states for search through states.

A state is a bit mask over literals: bit `l` is set if literal `l` holds; of literals `2 * i` and `2 * i + 1` exactly
one does. An action lists its few literals: masks of its own would each be as long as a state.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from tailor.executive.planning.ground.ground_action import GroundAction
from tailor.executive.planning.ground.ground_formula import GroundCondition
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.structures.connectives import Conjunction


class NotClassical(Exception):
    """The task has what search through states does not cover; the message names it."""


@dataclass(frozen=True, slots=True, eq=False)
class StripsAction:
    """A ground action: applicable where all of `needs` hold; then `made` holds, and its negations do not."""

    ground: GroundAction
    needs: tuple[int, ...]
    made: tuple[int, ...]

    def applies(self, state: int) -> bool:
        """Whether all that it needs holds."""
        return all(state >> literal & 1 for literal in self.needs)

    def after(self, state: int) -> int:
        """The state after the action, which must be applicable."""
        for literal in self.made:
            if not state >> literal & 1:
                state ^= 0b11 << (literal & ~1)  # the literal and its negation
        return state


@dataclass(frozen=True, slots=True, eq=False)
class StripsTask:
    """A task whose conditions are conjunctions of literals; actions that no relaxed plan reaches are left out."""

    actions: tuple[StripsAction, ...]
    literals: int  # number of them
    initial: int
    goal: tuple[int, ...]
    goal_mask: int


def strips_task(task: GroundTask, actions: Sequence[GroundAction]) -> StripsTask:
    """The task for search through states, given all ground actions by number.

    Raises:
      NotClassical: It has durations, timed literals, disjunctions or conditional effects.
    """
    if task.temporal:
        raise NotClassical("durations or timed literals")
    literals = len(task.names)
    reached = tuple(_strips_action(actions[number]) for number in sorted(task.estimates.reached))
    goal = _literals(task.goal)
    return StripsTask(reached, literals, mask_of(task.initial), goal, mask_of(goal))


def mask_of(literals: Iterable[int]) -> int:
    """The mask with the bits of some literals."""
    mask = 0
    for literal in literals:
        mask |= 1 << literal
    return mask


def _strips_action(action: GroundAction) -> StripsAction:
    if not action.simple:
        raise NotClassical(f"conditional effects of {action}")
    needs = _literals([condition for condition, _ in action.conditions])
    made = tuple(dict.fromkeys(effect.literal for effect in action.effects))
    return StripsAction(action, needs, made)


def _literals(conditions: Iterable[GroundCondition]) -> tuple[int, ...]:
    """The literals of a conjunction of conditions."""
    found: dict[int, None] = {}
    for condition in conditions:
        if isinstance(condition, int):
            found.setdefault(condition)
        elif isinstance(condition, Conjunction):
            found.update(dict.fromkeys(_literals(condition.parts)))
        else:
            raise NotClassical("disjunctions")
    return tuple(found)
