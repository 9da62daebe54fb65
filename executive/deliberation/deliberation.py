"""One pass of Algorithm 1: plan, instantiate, assert, refine. Anytime and resumable from tick to tick."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from tailor.executive import planning
from tailor.executive.deliberation.context import Context
from tailor.executive.deliberation.plan_found import PlanFound
from tailor.executive.deliberation.plan_selection import PlanSelection
from tailor.executive.deliberation.plan_source import PlanSource
from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.executive.interfaces.values import Belief
from tailor.executive.refinement.assertion.assertion import Assertion
from tailor.executive.refinement.assertion.relaxed_limits import relaxed
from tailor.executive.refinement.belief_monitor import BeliefMonitor
from tailor.executive.refinement.objective.choice import Choice
from tailor.executive.refinement.objective.sequence import ActionSequence, Failure
from tailor.executive.refinement.refinement import Refinement

Stage = Literal["planning", "asserting", "refining", "decided", "failed"]


@dataclass(frozen=True, slots=True)
class Decision:
    """Result of a deliberation: a plan, its executable actions, and values for their free parameters."""

    plan: planning.Plan
    sequence: ActionSequence
    choice: Choice
    number: int  # of its deliberation
    made_ns: int  # time of the belief that it was made from: its predictions count from there
    watch: BeliefMonitor = field(compare=False, repr=False)  # detects that the belief left the sequence's bindings


class Deliberation:
    """Decision making from one snapshot of the belief; owned by one state, changed in place."""

    def __init__(
        self,
        context: Context,
        belief: Belief,
        now_ns: int,
        number: int,
        source: PlanSource,
        start: Mapping[tuple[str, str], float] | None = None,
    ) -> None:
        """Prepare a deliberation; all work is done in `advance`.

        Args:
          context: Domain, models and settings.
          belief: The belief from which parameters are instantiated.
          now_ns: Time of the belief.
          number: Serial number of this deliberation; with the seed it fixes every random draw.
          source: Source of its plan.
          start: Values by label and quantity with which refinement begins, if it finds none that are better at once.
        """
        self.number = number
        self.ticks = 0  # that it has taken
        self.stage: Stage = "planning"
        self.failure: Cause | None = None
        self.source = source
        self.plan_results: tuple[PlanFound, ...] = ()  # of the source; the last one counts
        self.sequence: ActionSequence | None = None
        self.refinement: Refinement | None = None
        self._context = context
        self._now_ns = now_ns
        self._start = start or {}
        self._rng = np.random.default_rng([context.settings.seed, 3, number])
        self._selection = PlanSelection(context, belief, source, number)
        self._watch: BeliefMonitor | None = None
        self._assertion: Assertion | None = None

    @property
    def plan(self) -> planning.Plan | None:
        """The plan, None if there is none yet."""
        return self.plan_results[-1].plan if self.plan_results else None

    def advance(self, budget: Budget) -> None:
        """Continue until decided, failed, or out of budget."""
        stages = {"planning": self._plan, "asserting": self._assert, "refining": self._refine}
        self.ticks += self.stage in stages
        while self.stage in stages:
            stage = self.stage
            stages[stage](budget)
            if self.stage == stage:
                return

    def settle(self) -> None:
        """End the search with what it has found."""
        if self.stage == "refining" and self.decision() is not None:
            self.stage = "decided"

    def pause(self, passed_ns: int) -> None:
        """Let time pass in which the clock of the running action stands still: predictions count from that clock."""
        self._now_ns += passed_ns

    def certify(self, budget: Budget) -> None:
        """Once decided, tighten the bound of the optimality gap: the choice against the optimum of the models."""
        if self.stage == "decided" and self.refinement is not None:
            self.refinement.certify(budget)

    def decision(self) -> Decision | None:
        """The best decision so far; None while there is no plan that can be executed."""
        if self.refinement is None or self.sequence is None or self.plan is None:
            return None
        choice = self.refinement.choice
        if choice is None or not choice.valid:
            return None
        assert self._watch is not None
        return Decision(self.plan, self.sequence, choice, self.number, self._now_ns, self._watch)

    def nothing_to_do(self) -> bool:
        """Whether the goal already holds: the plan has no steps."""
        return self.plan is not None and not self.plan.steps

    def _plan(self, budget: Budget) -> None:
        result = self._selection.advance(budget)
        if result is None:
            return
        self.plan_results += (result,)
        if result.status == "failed":  # the external planner; the built-in search follows
            return
        if result.plan is None:
            self._fail(result.refusal)
            return
        if not result.plan.steps:
            self.stage = "decided"
            return
        self._instantiate()

    def _instantiate(self) -> None:
        sequence, settings = self._selection.sequence, self._context.settings.refinement
        if isinstance(sequence, Failure):
            self._fail(Cause(Reason.NOT_INSTANTIABLE, sequence.reason))
            return
        self._assertion = Assertion(sequence, self._context.models, settings, self._rng)
        self.stage = "asserting"

    def _assert(self, budget: Budget) -> None:
        assert self._assertion is not None
        sequence = self._assertion.advance(budget)
        if sequence is None:
            return
        if isinstance(sequence, Failure):
            self._fail(Cause(Reason.NO_SUBGOAL, sequence.reason))
            return
        self._begin_refinement(sequence)

    def _begin_refinement(self, sequence: ActionSequence) -> None:
        assert self._selection.pattern is not None
        self.sequence = sequence
        self._watch = BeliefMonitor(self._selection.pattern, sequence)
        self.refinement = Refinement(
            sequence,
            self._context.models,
            self._context.settings.refinement,
            self._rng,
            sequence.values_of(self._start),
        )
        self.stage = "refining"

    def _refine(self, budget: Budget) -> None:
        assert self.refinement is not None
        assert self.sequence is not None
        self.refinement.advance(budget)
        if not self.refinement.finished:
            return
        choice = self.refinement.choice
        if choice is not None and choice.valid:
            self.stage = "decided"
        elif (sequence := relaxed(self.sequence, self._context.settings.refinement)) is not None:
            self._begin_refinement(sequence)
        else:
            self._fail(Cause(Reason.NO_VALID_CHOICE))

    def _fail(self, cause: Cause | None) -> None:
        self.stage = "failed"
        self.failure = cause
