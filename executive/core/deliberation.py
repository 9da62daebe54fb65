"""One pass of Algorithm 1: plan, instantiate, assert, refine. Anytime and resumable from tick to tick."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from tailor.executive import planning
from tailor.executive.core.context import Context
from tailor.executive.core.plan_finding import PlanFinding, PlanFound
from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.values import Belief
from tailor.executive.refinement.assertion.assertion import Assertion
from tailor.executive.refinement.belief_monitor import BeliefMonitor
from tailor.executive.refinement.instantiation import Pattern
from tailor.executive.refinement.objective.choice import Choice
from tailor.executive.refinement.objective.sequence import ActionSequence, Failure
from tailor.executive.refinement.refinement import Refinement
from tailor.schemas.messages import PlanAnswer, PlanRequest

Stage = Literal["planning", "asserting", "refining", "decided", "failed"]


@dataclass(frozen=True, slots=True)
class Decision:
    """What to do: a plan, its executable actions, and values for their free parameters."""

    plan: planning.Plan
    sequence: ActionSequence
    choice: Choice
    number: int  # which deliberation it came from
    watch: BeliefMonitor = field(compare=False, repr=False)  # tells when the sequence no longer fits the belief


class Deliberation:
    """Decides what to do from one snapshot of the belief; owned by one state, changed in place."""

    def __init__(self, context: Context, belief: Belief, number: int, source: PlanFound | PlanFinding) -> None:
        """Start deciding what to do from `belief`.

        Args:
          context: Domain, models and settings.
          belief: What parameters are instantiated from.
          number: Serial number of this deliberation; with the seed it fixes every random draw.
          source: A plan that is known to be sound, or the way to one.
        """
        self.number = number
        self.stage: Stage = "planning"
        self.reason = ""
        self.told: tuple[PlanFound, ...] = ()  # all that came of planning; the last one counts
        self.sequence: ActionSequence | None = None
        self.refinement: Refinement | None = None
        self._context = context
        self._belief = belief
        self._rng = np.random.default_rng([context.settings.seed, 3, number])
        self._pattern: Pattern | None = None
        self._watch: BeliefMonitor | None = None
        self._assertion: Assertion | None = None
        self._finding: PlanFinding | None = None
        if isinstance(source, PlanFinding):
            self._finding = source
        else:
            self._planned(source)

    @property
    def found(self) -> PlanFound | None:
        """The plan, or how planning has stood so far."""
        return self.told[-1] if self.told else None

    @property
    def request(self) -> PlanRequest | None:
        """What an external planner has been asked and has not answered yet."""
        return self._finding.request if self._finding is not None else None

    def take(self, answer: PlanAnswer) -> None:
        """The external planner's answer."""
        if self._finding is not None:
            self._finding.take(answer)

    def advance(self, budget: Budget) -> None:
        """Go on until decided, failed, or out of budget."""
        stages = {"planning": self._plan, "asserting": self._assert, "refining": self._refine}
        while self.stage in stages:
            stage = self.stage
            stages[stage](budget)
            if self.stage == stage:
                return

    def certify(self, budget: Budget) -> None:
        """Once decided, prove how near the choice is to the optimum of the models."""
        if self.stage == "decided" and self.refinement is not None:
            self.refinement.certify(budget)

    def decision(self) -> Decision | None:
        """The best decision so far; None while there is no plan that can be executed."""
        if self.refinement is None or self.sequence is None or self.found is None or self.found.plan is None:
            return None
        choice = self.refinement.choice
        if choice is None or not choice.valid:
            return None
        assert self._watch is not None
        return Decision(self.found.plan, self.sequence, choice, self.number, self._watch)

    def nothing_to_do(self) -> bool:
        """Whether the goal already holds: a plan was found and has no steps."""
        return self.found is not None and self.found.plan is not None and not self.found.plan.steps

    def _plan(self, budget: Budget) -> None:
        assert self._finding is not None
        found = self._finding.advance(budget)
        if found is None:
            return
        if found.status == "failed":
            self.told += (found,)
        else:
            self._planned(found)

    def _planned(self, found: PlanFound) -> None:
        self.told += (found,)
        if found.plan is None:
            self._fail(f"no plan: {found.reason or found.status}")
            return
        if not found.plan.steps:
            self.stage = "decided"
            return
        self._pattern = Pattern(found.plan, self._context.domain, self._context.scenario)
        sequence = self._pattern.sequence(self._belief)
        if isinstance(sequence, Failure):
            self._fail(f"cannot instantiate: {sequence.reason}")
            return
        settings = self._context.settings.refinement
        self._assertion = Assertion(sequence, self._context.models, settings, self._rng)
        self.stage = "asserting"

    def _assert(self, budget: Budget) -> None:
        assert self._assertion is not None
        assert self._pattern is not None
        sequence = self._assertion.advance(budget)
        if sequence is None:
            return
        if isinstance(sequence, Failure):
            self._fail(f"no subgoal helps: {sequence.reason}")
            return
        self.sequence = sequence
        self._watch = BeliefMonitor(self._pattern, sequence)
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
