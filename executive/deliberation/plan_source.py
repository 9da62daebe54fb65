"""Sources of plans: the external planner if configured, otherwise the built-in search.

Every plan is validated before use. The built-in search takes over when the external planner fails.
"""

from __future__ import annotations

from collections.abc import Callable

from tailor.executive import planning
from tailor.executive.deliberation.context import Context
from tailor.executive.deliberation.plan_found import PlanFound, answered, validated
from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.values import Fact
from tailor.schemas.messages import PlanAnswer, PlanRequest

GRACE_S = 2.0  # beyond the planner's own limit; after that the process that runs it must be gone
REUSE_FREE_PORTIONS = 128  # plans of some twenty steps


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
        stamp_ns: int,
        reuse: planning.Work[PlanFound | None] | None = None,
        make_request: Callable[[int], PlanRequest] | None = None,
    ) -> None:
        """Prepare the search; all work is done in `advance`.

        Args:
          context: Domain and settings.
          problem: Problem to solve.
          ground: Grounding of earlier searches; reused while the objects stay the same.
          stamp_ns: Stamp of this tick; that of each later one comes with `check_timeout`.
          reuse: Work whose result is a plan that is sound from the problem's initial state, or None. Nothing is
            searched or requested unless it ends without a plan.
          make_request: Makes the request to an external planner from its stamp, published by the caller; None: built-in
            search only.
        """
        self.request: PlanRequest | None = None  # until it is answered
        self._stamp_ns, self._make_request = stamp_ns, make_request
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
        self._stamp_ns = stamp_ns
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
            self.request, self._make_request = self._make_request(self._stamp_ns), None

    def _next(self, budget: Budget) -> planning.Work[PlanFound] | None:
        """The work on what the external planner or the search has come to; None if there is nothing yet."""
        if self.request is not None:
            if self._answer is None or budget.spent():
                return None
            self.request = None
            return answered(self._answer, self._domain, self.problem)
        limited = budget if self._make_request is None else _HeadStart(budget, self._search, self._after_plans)
        result = self._search.advance(limited)
        if result is not None and (self._make_request is None or result.status in ("solved", "unsolvable")):
            return validated(result, "searched", self._domain, self.problem)
        self._request_if_due(ended=result is not None)
        return None


def request_for(context: Context, problem: planning.Problem, number: int, stamp_ns: int) -> PlanRequest:
    """Request to the external planner, with PDDL texts of domain and problem."""
    return PlanRequest(stamp_ns, number, context.domain.pddl, planning.format_problem(problem))


def current_problem(context: Context, facts: frozenset[Fact], goal: str) -> planning.Problem:
    """The scenario's problem with `facts` as its initial state; an empty goal keeps the scenario's own."""
    problem = context.problem.with_initial(sorted(facts))
    return problem.with_goal(goal) if goal else problem
