"""The ground task of a search: reachable ground actions, initial literals, goal, estimates."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from typing import Literal as OneOf

from tailor.executive.planning.ground.achievers import Achiever, achievers_of
from tailor.executive.planning.ground.additive_heuristic import PORTION, Estimates, action_costs, estimate
from tailor.executive.planning.ground.durations import TimeGrid
from tailor.executive.planning.ground.goal_grounding import ground_in_portions
from tailor.executive.planning.ground.ground_formula import (
    FactTable,
    GroundCondition,
    GroundingLimit,
    contradictory,
)
from tailor.executive.planning.ground.grounding import GroundActions
from tailor.executive.planning.pddl.language import Literal
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.structures.connectives import FALSE, Disjunction, conjuncts
from tailor.executive.planning.structures.orderings import FIRST, GOAL, GOAL_STEP, Closure, Orderings
from tailor.executive.planning.structures.temporal_network import TemporalNetwork

CostOf = OneOf["unit", "duration", "relative", "metric"]


@dataclass(frozen=True, slots=True, eq=False)
class GroundTask:
    """A ground planning problem; literals as in `ground_formula`, achievers by literal as in `achievers_of`."""

    problem: Problem
    temporal: bool
    grid: TimeGrid
    names: tuple[Literal, ...]
    initial: frozenset[int]
    timed: tuple[tuple[int, int], ...]  # literal, time in units of the grid
    goal: tuple[GroundCondition, ...]
    achievers: tuple[tuple[Achiever, ...], ...]
    costs: tuple[float, ...]  # by action number
    estimates: Estimates
    simple: bool  # no action has conditional effects
    first_node: int  # node of the first step, after the initial state, the goal and the timed literals
    moments: int  # nodes of a step: start and end, or only one if actions take no time

    def initial_orderings(self) -> Orderings:
        """Those of a plan without steps."""
        if not self.temporal:
            return Closure()
        return TemporalNetwork.start(tuple(time for _, time in self.timed), self.grid.separation)

    def step_of(self, node: int) -> int:
        """The step that a node belongs to: 0 for the initial state and timed literals, GOAL_STEP for the goal."""
        if node == GOAL:
            return GOAL_STEP
        beyond = node - self.first_node
        return 1 + beyond // self.moments if beyond >= 0 else 0

    def node_of(self, step: int) -> int:
        """The first node of a step."""
        return self.first_node + (step - 1) * self.moments

    def has_alternatives_over_all(self) -> bool:
        """Whether an action has a condition over all with alternatives, of which any may hold at any time.

        Plan space keeps to one of them for the whole action, so it lacks plans in which they take turns.
        """
        actions = {action for achievers in self.achievers for action, _ in achievers}
        conditions = (condition for action in actions for condition in action.conditions)
        return any(isinstance(part, Disjunction) and first < last for part, (first, last) in conditions)


def make_task(problem: Problem, grounded: GroundActions, cost: CostOf = "unit") -> Generator[None, None, GroundTask]:
    """The task of a problem, given the ground actions of its static world; yields as a unit of budget is used."""
    facts = FactTable(grounded.facts, GroundingLimit(subject="the goal"))
    whole_goal = yield from ground_in_portions(problem.goal, grounded.world, facts)
    goal = tuple(dict.fromkeys(conjuncts(whole_goal)))  # each once, or each would be an open condition
    if contradictory(goal):
        goal = (FALSE,)
    if large := len(facts) > PORTION:  # what follows takes a millisecond for a thousand facts or two
        yield
    holding = {facts.literal(fact) for fact in problem.initial if fact[0] not in grounded.world.static}
    timed = tuple(
        (facts.literal(t.literal.fact, t.literal.positive), grounded.grid.units(t.time_s)) for t in problem.timed
    )
    initial = frozenset(literal for n in range(len(facts)) for literal in (2 * n + (2 * n not in holding),))
    if large:
        yield
    temporal = problem.domain.durative or bool(timed)
    costs = action_costs([(action.cost, action.duration_s) for action in grounded.actions], cost)
    first = initial | {literal for literal, _ in timed}
    estimates = yield from estimate(grounded.actions, costs, first, 2 * len(facts))
    achievers = yield from achievers_of(grounded.actions, estimates, 2 * len(facts))
    if large:
        yield
    names = facts.names()
    if large:
        yield
    return GroundTask(
        problem,
        temporal,
        grounded.grid,
        names,
        initial,
        timed,
        goal,
        achievers,
        costs,
        estimates,
        all(action.simple for action in grounded.actions),
        FIRST + len(timed),
        2 if temporal else 1,
    )
