"""How a deliberation comes by its plan: from an external planner where one is asked, else from our own search.

Whatever comes back is validated before it is believed. Our own planner takes over when the external one fails.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from tailor.executive import planning
from tailor.executive.core.context import Context
from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.values import Fact
from tailor.schemas.messages import PlanAnswer, PlanRequest

Way = Literal["searched", "suffix", "improved", "external"]


@dataclass(frozen=True, slots=True)
class PlanFound:
    """How the planning stage ended; `status` as in planning.Result, or "failed" for an external planner."""

    status: str
    way: Way
    plan: planning.Plan | None
    generated: int
    visited: int
    reason: str


class PlanFinding:
    """The way from one problem to a plan, resumable from tick to tick."""

    def __init__(
        self,
        context: Context,
        problem: planning.Problem,
        ground: planning.GroundCache,
        request: PlanRequest | None = None,
    ) -> None:
        """Prepares; all work is done in `advance`.

        Args:
          context: Domain and settings.
          problem: What to solve.
          ground: The grounding of earlier searches, which serves again while the objects stand.
          request: What the external planner is asked, by whoever carries it there; None: our own planner alone.
        """
        self.request = request  # until it is answered
        self._answer: PlanAnswer | None = None
        self._domain = context.pddl_domain
        self._problem = problem
        self._search = planning.Search(context.pddl_domain, problem, context.settings.planner, ground)

    def take(self, answer: PlanAnswer) -> None:
        """The external planner's answer; the first one to the request counts."""
        if self.request is not None and answer.id == self.request.id and self._answer is None:
            self._answer = answer

    def advance(self, budget: Budget) -> PlanFound | None:
        """Go on until there is news or the budget is spent. News of a failed external planner is not the last."""
        if self.request is not None:
            if self._answer is None or budget.spent():
                return None
            self.request = None
            return _read(self._answer, self._domain, self._problem)
        result = self._search.advance(budget)
        return validated(result, "searched", self._domain, self._problem) if result is not None else None


def validated(result: planning.Result, way: Way, domain: planning.Domain, problem: planning.Problem) -> PlanFound:
    """What our own search found, its plan simulated from the problem's initial state."""
    plan, reason = result.plan, result.reason
    if plan is not None:
        reason = planning.validate(plan, domain, problem)
        plan = plan if not reason else None
    return PlanFound(result.status, way, plan, result.generated, result.visited, reason)


def request_for(context: Context, problem: planning.Problem, number: int, now_ns: int) -> PlanRequest:
    """The problem as an external planner is asked it."""
    return PlanRequest(context.stamp(now_ns), number, context.domain.pddl, planning.format_problem(problem))


def problem_of_now(context: Context, facts: frozenset[Fact], goal: str) -> planning.Problem:
    """The scenario's problem with the abstract state of now and the goal that was set."""
    known = context.problem.with_initial(sorted(facts))
    return known.with_goal(goal) if goal else known


def _read(answer: PlanAnswer, domain: planning.Domain, problem: planning.Problem) -> PlanFound:
    plan = _plan_in(answer, domain, problem)
    if isinstance(plan, planning.Plan):
        return PlanFound("solved", "external", plan, 0, 0, "")
    return PlanFound("failed", "external", None, 0, 0, f"{plan}; our own planner takes over")


def _plan_in(answer: PlanAnswer, domain: planning.Domain, problem: planning.Problem) -> planning.Plan | str:
    """The plan, or why there is none."""
    if answer.outcome != "answered":
        return f"{answer.outcome}: {answer.reason}"
    try:
        plan = planning.completed(planning.parse_plan(answer.output), domain, problem)
    except planning.PlanTextError as error:
        return f"{answer.reason}; {error}"
    return plan if isinstance(plan, planning.Plan) else f"its plan is unsound: {plan}"
