"""One pass of Algorithm 1: plan, instantiate, assert, refine. Anytime and resumable from tick to tick."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from executive import planning
from executive.budget import Budget
from executive.core.context import Context
from executive.library import Belief, Fact
from executive.refinement.assertion import Assertion
from executive.refinement.instantiation import ActionSequence, Failure, instantiate
from executive.refinement.refinement import Choice, Refinement

Stage = Literal["planning", "asserting", "refining", "decided", "failed"]


@dataclass(frozen=True, slots=True)
class Decision:
    """What to do: a plan, its executable actions, and values for their free parameters."""

    plan: planning.Plan
    sequence: ActionSequence
    choice: Choice
    number: int  # which deliberation it came from


@dataclass(frozen=True, slots=True)
class PlanFound:
    """How the planning stage ended."""

    status: str
    way: Literal["searched", "suffix"]
    plan: planning.Plan | None
    generated: int
    visited: int
    reason: str


class Deliberation:
    """Decides what to do from one snapshot of the belief; owned by one state, changed in place."""

    def __init__(
        self,
        context: Context,
        belief: Belief,
        problem: planning.Problem,
        number: int,
        ground: planning.GroundCache,
        previous: planning.Plan | None = None,
        done: frozenset[int] = frozenset(),
    ) -> None:
        """Start deciding how to solve `problem` from `belief`.

        Args:
          number: Serial number of this deliberation; with the seed it fixes every random draw.
          ground: The grounding of earlier deliberations, which serves again while the objects stand.
          previous: The plan so far, of which the steps `done` have been executed.
        """
        self.number = number
        self.stage: Stage = "planning"
        self.reason = ""
        self.found: PlanFound | None = None
        self.sequence: ActionSequence | None = None
        self.refinement: Refinement | None = None
        self._context = context
        self._belief = belief
        self._problem = problem
        self._rng = np.random.default_rng([context.settings.seed, 3, number])
        self._assertion: Assertion | None = None
        self._ground = ground
        self._search: planning.Search | None = None
        self._reuse(previous, done)

    def advance(self, budget: Budget) -> None:
        """Go on until decided, failed, or out of budget."""
        stages = {"planning": self._plan, "asserting": self._assert, "refining": self._refine}
        while self.stage in stages:
            stage = self.stage
            stages[stage](budget)
            if self.stage == stage:
                return

    def decision(self) -> Decision | None:
        """The best decision so far; None while there is no plan that can be executed."""
        if self.refinement is None or self.sequence is None or self.found is None or self.found.plan is None:
            return None
        choice = self.refinement.choice
        if choice is None or not choice.valid:
            return None
        return Decision(self.found.plan, self.sequence, choice, self.number)

    def nothing_to_do(self) -> bool:
        """Whether the goal already holds: a plan was found and has no steps."""
        return self.found is not None and self.found.plan is not None and not self.found.plan.steps

    def _reuse(self, previous: planning.Plan | None, done: frozenset[int]) -> None:
        """Take the shortest suffix of the last plan that is sound from now: what the world did for us is left out."""
        if previous is None:
            return
        remaining = [step.id for step in previous.steps if step.id not in done]
        for skipped in range(len(remaining), -1, -1):
            left_out = done | set(remaining[:skipped])
            plan = planning.suffix(previous, left_out, self._context.pddl_domain, self._problem)
            if plan is not None:
                self._planned(PlanFound("solved", "suffix", plan, 0, 0, ""))
                return

    def _plan(self, budget: Budget) -> None:
        if self._search is None:
            context = self._context
            self._search = planning.Search(context.pddl_domain, self._problem, context.settings.planner, self._ground)
        result = self._search.advance(budget)
        if result is None:
            return
        plan, reason = result.plan, result.reason
        if plan is not None:
            reason = planning.validate(plan, self._context.pddl_domain, self._problem)
            plan = plan if not reason else None
        self._planned(PlanFound(result.status, "searched", plan, result.generated, result.visited, reason))

    def _planned(self, found: PlanFound) -> None:
        self.found = found
        if found.plan is None:
            self._fail(f"no plan: {found.reason or found.status}")
            return
        if not found.plan.steps:
            self.stage = "decided"
            return
        sequence = instantiate(found.plan, self._context.domain, self._belief, self._context.scenario)
        if isinstance(sequence, Failure):
            self._fail(f"cannot instantiate: {sequence.reason}")
            return
        settings = self._context.settings.refinement
        self._assertion = Assertion(sequence, self._context.models, settings, self._rng)
        self.stage = "asserting"

    def _assert(self, budget: Budget) -> None:
        assert self._assertion is not None
        sequence = self._assertion.advance(budget)
        if sequence is None:
            return
        if isinstance(sequence, Failure):
            self._fail(f"no subgoal helps: {sequence.reason}")
            return
        self.sequence = sequence
        self.refinement = Refinement(
            sequence, self._context.models, self._context.settings.refinement, self._rng, start=None
        )
        self.stage = "refining"

    def _refine(self, budget: Budget) -> None:
        assert self.refinement is not None
        self.refinement.advance(budget)
        if not self.refinement.finished:
            return
        choice = self.refinement.choice
        if choice is None or not choice.valid:
            self._fail("no valid subgoal: every choice of the free parameters is predicted to fail")
            return
        self.stage = "decided"

    def _fail(self, reason: str) -> None:
        self.stage = "failed"
        self.reason = reason


def problem_of_now(context: Context, facts: frozenset[Fact], goal: str) -> planning.Problem:
    """The scenario's problem with the abstract state of now and the goal that was set."""
    known = context.problem.with_initial(sorted(facts))
    return known.with_goal(goal) if goal else known
