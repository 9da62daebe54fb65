"""Which plan is executed: the source's, or another one where that is refused or the models predict it to be faster.

The planner knows nothing of values: the predicates over a label of its plan may exclude each other, or the label may
have none of the values that an action takes. Other plans are then tried in the order in which they are found.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from tailor.executive import planning
from tailor.executive.deliberation.context import Context
from tailor.executive.deliberation.plan_found import PlanFound
from tailor.executive.deliberation.plan_source import PlanSource
from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.executive.interfaces.values import Belief
from tailor.executive.refinement.instantiation import MAX_ACTIONS, Pattern
from tailor.executive.refinement.objective.sequence import ActionSequence, Failure
from tailor.executive.refinement.plan_choice import MAX_STEPS, PlanChoice, score_for

ALTERNATIVES_LIMIT = 3000  # plans generated in each search of other plans: at most half a second


class _FirstInstantiable:
    """The first of other plans whose instantiation is not refused; resumable, `best` is the answer."""

    def __init__(
        self, first: planning.Plan, others: planning.PlanEnumeration, refusal: Callable[[planning.Plan], Cause | None]
    ) -> None:
        self.best = first
        self._others, self._refusal = others, refusal

    def advance(self, budget: Budget) -> bool:
        """Continue until there is one or there are no others (True), or the budget is spent (False)."""
        while (plan := self._others.advance(budget)) is not None:
            if self._refusal(plan) is None:
                self.best = plan
                return True
        return self._others.finished


class PlanSelection:
    """Selection of one deliberation's plan; resumable from tick to tick.

    Args:
      context: Domain, scenario, models and settings.
      belief: From which parameters are instantiated.
      source: Of plans.
      number: Of the deliberation; with the seed it fixes every random draw.
    """

    def __init__(self, context: Context, belief: Belief, source: PlanSource, number: int) -> None:
        self.pattern: Pattern | None = None  # of the plan last selected, unless it has no steps
        self.sequence: ActionSequence | Failure = Failure("no plan")
        self._context, self._belief, self._source, self._number = context, belief, source, number
        self._instead: PlanFound | None = None  # of the plan last refused
        self._found: PlanFound | None = None  # whose plan is compared with others
        self._choice: PlanChoice | _FirstInstantiable | None = None
        self._check: planning.PacedWork[str] | None = None  # of the plan chosen

    def advance(self, budget: Budget) -> PlanFound | None:
        """Continue until a plan is selected or the source has none, or the budget is spent.

        Returns:
          What the source has found, with the plan that is selected; None if there is nothing yet. After a failed
          external planner another result follows.
        """
        while self._found is None:
            found = self._instead or self._source.advance(budget)
            self._instead = None
            if found is None or found.plan is None or not found.plan.steps:
                return found
            if found.way == "searched":
                self._choice = self._choice_from(found.plan)
                if self._choice is None:
                    return found
                self._found = found
            elif (refusal := self._refusal(found.plan)) is None:
                return found
            elif found.way == "external":
                return replace(found, status="failed", plan=None, refusal=refusal)
            else:
                self._instead = found.instead
        return self._chosen(budget)

    def _choice_from(self, first: planning.Plan) -> PlanChoice | _FirstInstantiable | None:
        """A comparison of the search's plan with others; None if none is needed."""
        context, source = self._context, self._source
        by_models = context.settings.plan_costs == "models" and len(first.steps) <= MAX_STEPS
        if not by_models and self._refusal(first) is None:
            return None
        settings = replace(context.settings.planner, node_limit=ALTERNATIVES_LIMIT)
        others = planning.PlanEnumeration(source.problem, settings, source.ground, first)
        if not by_models:
            return _FirstInstantiable(first, others, self._refusal)
        seed = [context.settings.seed, 4, self._number]
        score = score_for(
            context.domain, context.scenario, context.models, context.settings.refinement, self._belief, seed
        )
        return PlanChoice(first, others, score)

    def _chosen(self, budget: Budget) -> PlanFound | None:
        """The search's result with the plan that the comparison ends with, if that is sound; None while it goes on."""
        found, choice = self._found, self._choice
        assert found is not None
        assert choice is not None
        if self._check is None and not choice.advance(budget):
            return None
        if found.plan is not choice.best:
            if self._check is None:
                objects = planning.Objects(self._source.problem)
                self._check = planning.PacedWork(planning.validation(choice.best, self._context.pddl_domain, objects))
            if not self._check.advance(budget):
                return None
            found = found if self._check.result else replace(found, plan=choice.best)
        assert found.plan is not None
        self._refusal(found.plan)
        self._found, self._choice, self._check = None, None, None
        return found

    def _refusal(self, plan: planning.Plan) -> Cause | None:
        """Why a plan cannot be instantiated, None if it can; `pattern` and `sequence` are its own from now on."""
        length = max(MAX_ACTIONS, self._context.settings.refinement.horizon)
        self.pattern = Pattern(plan, self._context.domain, self._context.scenario, length)
        self.sequence = self.pattern.sequence(self._belief)
        return Cause(Reason.NOT_INSTANTIABLE, self.sequence.reason) if isinstance(self.sequence, Failure) else None
