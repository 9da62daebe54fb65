"""What a source of plans has found: a plan that was validated, or the cause for which there is none."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from tailor.executive import planning
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.schemas.messages import PlanAnswer

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

    `refusal` is the cause for which there is no plan; None if there is one. `instead` is the rest of the last plan,
    for where a better one cannot be instantiated.
    """

    status: str
    way: Way
    plan: planning.Plan | None
    generated: int
    visited: int
    refusal: Cause | None = None
    instead: PlanFound | None = None


def validated(
    result: planning.Result, way: Way, domain: planning.Domain, problem: planning.Problem
) -> planning.Work[PlanFound]:
    """Result of the built-in search; without its plan if that is unsound from the problem's initial state."""
    refusal = _REFUSALS.get(result.status)
    cause = Cause(refusal, _detail(result, problem)) if refusal is not None else None
    plan = result.plan
    if plan is not None and (fault := (yield from planning.validation(plan, domain, planning.Objects(problem)))):
        plan, cause = None, Cause(Reason.PLAN_UNSOUND, fault)
    if plan is not None and (limit := planning.too_large_to_execute(plan, domain, problem)):
        plan, cause = None, Cause(Reason.SEARCH_LIMIT, limit)
    return PlanFound(result.status, way, plan, result.generated, result.visited, cause)


def _detail(result: planning.Result, problem: planning.Problem) -> str:
    """Text of the search; what is unsolvable is so from a state, of which people can only guess what the belief has."""
    if result.status != "unsolvable":
        return result.reason
    changing = {effect.atom.predicate for action in problem.domain.actions for effect in action.effects}
    facts = sorted(f"({' '.join(fact)})" for fact in problem.initial if fact[0] in changing)
    shown = " ".join([*facts[:MAX_FACTS], *(["..."] if len(facts) > MAX_FACTS else [])])
    return f"{result.reason}, from {shown or 'a state without facts'}"


def answered(answer: PlanAnswer, domain: planning.Domain, problem: planning.Problem) -> planning.Work[PlanFound]:
    """The external planner's plan; without it if the answer has none, or one that is unsound."""
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
    if not isinstance(plan, planning.Plan):
        return Cause(Reason.PLAN_UNSOUND, plan)
    limit = planning.too_large_to_execute(plan, domain, problem)
    return Cause(Reason.PLAN_UNSOUND, limit) if limit else plan
