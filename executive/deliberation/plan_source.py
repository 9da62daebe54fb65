"""Sources of plans: the external planner if configured, otherwise the built-in search.

Every plan is validated before use. The built-in search takes over when the external planner fails.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from tailor.executive import planning
from tailor.executive.deliberation.context import Context
from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.executive.interfaces.values import Fact
from tailor.schemas.messages import PlanAnswer, PlanRequest

GRACE_S = 2.0  # beyond the planner's own limit; after that the process that runs it must be gone
REUSE_FREE_PORTIONS = 128  # plans of some twenty steps
MAX_FACTS = 12  # in the detail of a task that is unsolvable

Way = Literal["searched", "suffix", "improved", "external"]

_REFUSALS = {
    "unsolvable": Reason.UNSOLVABLE,
    "limit": Reason.SEARCH_LIMIT,
    "unsupported": Reason.PDDL_UNSUPPORTED,
}


@dataclass(frozen=True, slots=True)
class PlanFound:
    """Result of one source; `status` as in planning.Result, or "failed" for an external planner.

    `refusal` is the cause for which there is no plan; None if there is one.
    """

    status: str
    way: Way
    plan: planning.Plan | None
    generated: int
    visited: int
    refusal: Cause | None = None


class _HeadStart:
    """A budget that also ends when a search has refined so many plans."""

    def __init__(self, budget: Budget, search: planning.Search, plans: int) -> None:
        self._budget, self._search, self._plans = budget, search, plans
        self.granted = 0

    def spent(self) -> bool:
        """See `Budget`."""
        return self._search.counts[1] >= self._plans or self._budget.spent()


class PlanSource:
    """Plan for one problem, from the first source that yields one; resumable from tick to tick."""

    def __init__(
        self,
        context: Context,
        problem: planning.Problem,
        ground: planning.GroundCache,
        reuse: planning.Work[PlanFound | None] | None = None,
        make_request: Callable[[], PlanRequest] | None = None,
    ) -> None:
        """Prepare the search; all work is done in `advance`.

        Args:
          context: Domain and settings.
          problem: Problem to solve.
          ground: Grounding of earlier searches; reused while the objects stay the same.
          reuse: Work whose result is a plan that is sound from the problem's initial state, or None. Nothing is
            searched or requested unless it ends without a plan.
          make_request: Makes the request to the external planner, published by the caller; None: built-in search only.
        """
        self.request: PlanRequest | None = None  # until it is answered
        self._make_request = make_request
        self._answer: PlanAnswer | None = None
        self._limit_s = context.settings.external.limit_s + GRACE_S
        self._after_plans = context.settings.external.after_plans
        self._domain = context.pddl_domain
        self.problem, self.ground = problem, ground
        self._search = planning.Search(context.pddl_domain, problem, context.settings.planner, ground)
        self._work = planning.PacedWork(reuse, REUSE_FREE_PORTIONS) if reuse is not None else None  # or validation ...
        if reuse is None:
            self._request_if_due()

    def receive(self, answer: PlanAnswer) -> None:
        """Keep the first answer to the pending request; ignore answers to other requests."""
        if self.request is not None and answer.id == self.request.id and self._answer is None:
            self._answer = answer

    def check_timeout(self, stamp_ns: int) -> None:
        """Count a request without an answer as timed out at `stamp_ns`, planner.limit_s plus GRACE_S after it."""
        if self.request is not None and stamp_ns - self.request.stamp_ns > self._limit_s * 1e9:
            self.receive(PlanAnswer(stamp_ns, self.request.id, "timeout", "", f"no answer within {self._limit_s:g} s"))

    def advance(self, budget: Budget) -> PlanFound | None:
        """Continue until a source has a result or the budget is spent.

        Returns:
          The result; None if there is none yet. After a failed external planner another result follows.
        """
        while True:
            if self._work is None:
                work = self._next(budget)
                if work is None:
                    return None
                self._work = planning.PacedWork[PlanFound | None](work)
            if not self._work.advance(budget):
                return None
            found, self._work = self._work.result, None
            if found is not None:
                return found
            self._request_if_due()

    def _request_if_due(self, ended: bool = False) -> None:
        """Make the request, once, as soon as the search has had its head start or has ended."""
        if self._make_request is not None and (ended or self._search.counts[1] >= self._after_plans):
            self.request, self._make_request = self._make_request(), None

    def _next(self, budget: Budget) -> planning.Work[PlanFound] | None:
        """The work on what the external planner or the search has come to; None if there is nothing yet."""
        if self.request is not None:
            if self._answer is None or budget.spent():
                return None
            self.request = None
            return _from_answer(self._answer, self._domain, self.problem)
        limited = budget if self._make_request is None else _HeadStart(budget, self._search, self._after_plans)
        result = self._search.advance(limited)
        if result is not None and (self._make_request is None or result.status in ("solved", "unsolvable")):
            return validated(result, "searched", self._domain, self.problem)
        self._request_if_due(ended=result is not None)
        return None


def validated(
    result: planning.Result, way: Way, domain: planning.Domain, problem: planning.Problem
) -> planning.Work[PlanFound]:
    """Result of the built-in search; without its plan if that is unsound from the problem's initial state."""
    refusal = _REFUSALS.get(result.status)
    cause = Cause(refusal, _detail(result, problem)) if refusal is not None else None
    plan = result.plan
    if plan is not None and (fault := (yield from planning.validation(plan, domain, planning.Objects(problem)))):
        plan, cause = None, Cause(Reason.PLAN_UNSOUND, fault)
    return PlanFound(result.status, way, plan, result.generated, result.visited, cause)


def _detail(result: planning.Result, problem: planning.Problem) -> str:
    """Text of the search; what is unsolvable is so from a state, of which people can only guess what the belief has."""
    if result.status != "unsolvable":
        return result.reason
    changing = {effect.atom.predicate for action in problem.domain.actions for effect in action.effects}
    facts = sorted(f"({' '.join(fact)})" for fact in problem.initial if fact[0] in changing)
    shown = " ".join([*facts[:MAX_FACTS], *(["..."] if len(facts) > MAX_FACTS else [])])
    return f"{result.reason}, from {shown or 'a state without facts'}"


def request_for(context: Context, problem: planning.Problem, number: int, now_ns: int) -> PlanRequest:
    """Request to the external planner, with PDDL texts of domain and problem."""
    return PlanRequest(context.stamp(now_ns), number, context.domain.pddl, planning.format_problem(problem))


def current_problem(context: Context, facts: frozenset[Fact], goal: str) -> planning.Problem:
    """The scenario's problem with `facts` as its initial state; an empty goal keeps the scenario's own."""
    problem = context.problem.with_initial(sorted(facts))
    return problem.with_goal(goal) if goal else problem


def _from_answer(answer: PlanAnswer, domain: planning.Domain, problem: planning.Problem) -> planning.Work[PlanFound]:
    plan = yield from _parsed(answer, domain, problem)
    if isinstance(plan, planning.Plan):
        return PlanFound("solved", "external", plan, 0, 0)
    return PlanFound("failed", "external", None, 0, 0, plan)


def _parsed(
    answer: PlanAnswer, domain: planning.Domain, problem: planning.Problem
) -> planning.Work[planning.Plan | Cause]:
    """The plan of an answer, or the cause for which there is none."""
    if answer.outcome != "answered":
        return Cause(Reason.PLANNER_FAILED, f"{answer.outcome}: {answer.reason}")
    try:
        parsed = planning.parse_plan(answer.output)
    except planning.PlanTextError as error:
        return Cause(Reason.PLAN_UNREADABLE, f"{answer.reason}; {error}")
    yield
    plan = yield from planning.completion(parsed, domain, problem)
    return plan if isinstance(plan, planning.Plan) else Cause(Reason.PLAN_UNSOUND, plan)
