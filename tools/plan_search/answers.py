"""Makes plans of the answers of external planners."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tailor.executive.planning import Domain, Problem, Result
from tailor.executive.planning.pddl.syntax.errors import shortened
from tailor.schemas.errors import UsageError

if TYPE_CHECKING:
    from tailor.executive.planning import Plan
    from tailor.runtime.processes.planner_process import PlannerAnswer, PlannerProcess


def linked_answer(child: PlannerProcess, domain: Domain, problem: Problem) -> Result:
    """The plan of an external planner that has ended."""
    from tailor.executive.planning import completed

    answer = child.poll()
    assert answer is not None
    try:
        plan = completed(_parsed(answer, problem), domain, problem)
    except UsageError as error:
        return Result("limit", None, f"{answer.reason}{_verdict(answer.output) or f'; {error}'}", 0, 0)
    if isinstance(plan, str):
        return Result("limit", None, f"the planner's plan is unsound: {plan}", 0, 0)
    return Result("solved", plan, "", 0, 0)


def _parsed(answer: PlannerAnswer, problem: Problem) -> Plan:
    """The plan in an answer: of one without words that of no steps, if the goal holds already.

    Raises:
      UsageError: There is no plan.
    """
    from tailor.executive.planning import Plan, parse_plan, validate

    empty = Plan(problem.name, problem.initial, (), durative=problem.domain.durative)
    silent = answer.outcome == "answered" and all(line[:1] in ("", ";") for line in answer.output.splitlines())
    if silent and not validate(empty, problem.domain, problem):
        return empty
    return parse_plan(answer.output)


def _verdict(output: str) -> str:
    """What a planner states instead of a plan, such as VHPOP's "no plan"; empty if it printed steps, or nothing."""
    lines = [line for line in map(str.strip, output.splitlines()) if line and not line.startswith(";")]
    has_steps = any(line.lstrip("0123456789.: ").startswith("(") for line in lines)
    return f": '{shortened(lines[-1])}'" if lines and not has_steps else ""
