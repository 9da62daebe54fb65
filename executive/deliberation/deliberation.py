"""One pass of Algorithm 1: plan, instantiate, assert, refine. Anytime and resumable from tick to tick."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from tailor.executive import planning
from tailor.executive.deliberation.context import Context
from tailor.executive.deliberation.plan_found import PlanFound
from tailor.executive.deliberation.plan_source import PlanSource
from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.executive.interfaces.values import Belief
from tailor.executive.refinement.assertion.assertion import Assertion
from tailor.executive.refinement.assertion.relaxed_limits import relaxed
from tailor.executive.refinement.belief_monitor import BeliefMonitor
from tailor.executive.refinement.instantiation import MAX_ACTIONS, Pattern
from tailor.executive.refinement.objective.choice import Choice
from tailor.executive.refinement.objective.sequence import ActionSequence, Failure
from tailor.executive.refinement.plan_choice import PlanChoice, score_for
from tailor.executive.refinement.refinement import Refinement

ALTERNATIVES_LIMIT = 3000  # plans generated in search of other plans, with plan_costs = "models": at most half a second
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
        self._belief = belief
        self._now_ns = now_ns
        self._start = start or {}
        self._rng = np.random.default_rng([context.settings.seed, 3, number])
        self._found: PlanFound | None = None  # whose plan is being compared
        self._plan_choice: PlanChoice | None = None  # between the source's plan and others
        self._check: planning.PacedWork[str] | None = None  # of the plan chosen
        self._pattern: Pattern | None = None
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
        result = self._chosen(budget)
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
        self._instantiate(result.plan)

    def _chosen(self, budget: Budget) -> PlanFound | None:
        """The source's next result, of a search with the plan that the models predict to be fastest if so set."""
        if self._found is None:
            self._found = self.source.advance(budget)
            if self._found is None:
                return None
            if self._context.settings.plan_costs == "models" and self._found.way == "searched" and self._found.plan:
                self._plan_choice = self._choice_from(self._found.plan)
        choice = self._plan_choice
        if choice is not None and self._check is None and not choice.advance(budget):
            return None
        found = self._found
        if choice is not None and found.plan is not choice.best:
            if self._check is None:
                objects = planning.Objects(self.source.problem)
                self._check = planning.PacedWork(planning.validation(choice.best, self._context.pddl_domain, objects))
            if not self._check.advance(budget):
                return None
            found = found if self._check.result else replace(found, plan=choice.best)
        self._found, self._plan_choice, self._check = None, None, None
        return found

    def _choice_from(self, first: planning.Plan) -> PlanChoice:
        context, source = self._context, self.source
        settings = replace(context.settings.planner, node_limit=ALTERNATIVES_LIMIT)
        others = planning.PlanEnumeration(source.problem, settings, source.ground, first)
        seed = [context.settings.seed, 4, self.number]
        score = score_for(
            context.domain, context.scenario, context.models, context.settings.refinement, self._belief, seed
        )
        return PlanChoice(first, others, score)

    def _instantiate(self, plan: planning.Plan) -> None:
        settings = self._context.settings.refinement
        length = max(MAX_ACTIONS, settings.horizon)
        self._pattern = Pattern(plan, self._context.domain, self._context.scenario, length)
        sequence = self._pattern.sequence(self._belief)
        if isinstance(sequence, Failure):
            self._fail(Cause(Reason.NOT_INSTANTIABLE, sequence.reason))
            return
        self._assertion = Assertion(sequence, self._context.models, settings, self._rng)
        self.stage = "asserting"

    def _assert(self, budget: Budget) -> None:
        assert self._assertion is not None
        assert self._pattern is not None
        sequence = self._assertion.advance(budget)
        if sequence is None:
            return
        if isinstance(sequence, Failure):
            self._fail(Cause(Reason.NO_SUBGOAL, sequence.reason))
            return
        self._begin_refinement(sequence)

    def _begin_refinement(self, sequence: ActionSequence) -> None:
        assert self._pattern is not None
        self.sequence = sequence
        self._watch = BeliefMonitor(self._pattern, sequence)
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
