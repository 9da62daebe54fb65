"""Sources of a plan for the command line: the built-in search, an external planner, or one after the other."""

from __future__ import annotations

import math
import sys
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from tailor.executive.planning import Domain, Problem, Result, Search, Settings
from tailor.executive.planning.pddl.formula_text import format_number
from tailor.runtime.planners.named import DURATIVE_HEAD_START, kairos_command
from tailor.tools.plan_search.answers import linked_answer
from tailor.tools.plan_search.limits import Limits

if TYPE_CHECKING:
    from tailor.executive.planning import AnytimeSearch, Plan
    from tailor.runtime.processes.planner_process import PlannerProcess

GRACE_S = 5.0  # of kairos-planner, beyond its own time limit
_POLL_S = 0.002  # period of polling an external planner


@dataclass(slots=True)
class _HeadStart:
    """Grants work within the limits until the search has refined so many plans."""

    limits: Limits
    search: Search
    plans: int
    granted: int = 0

    def spent(self) -> bool:
        """See `Budget`."""
        self.granted += 1
        return self.search.counts[1] >= self.plans or self.limits.spent()


def built_in(domain: Domain, problem: Problem, settings: Settings, limits: Limits) -> Result:
    """The result of the built-in search."""
    return _searched(Search(domain, problem, settings), limits)


def with_kairos(
    texts: tuple[str, str], domain: Domain, problem: Problem, settings: Settings, limits: Limits
) -> tuple[Result, str]:
    """The built-in search with a head start, then kairos-planner's first plan, then the rest of the search.

    Returns:
      The result, and the name of the planner that found it; "" for the built-in search.
    """
    search = Search(domain, problem, settings)
    result = search.advance(_HeadStart(limits, search, DURATIVE_HEAD_START))
    if result is not None and result.status not in ("limit", "unsupported"):
        return result, ""
    if limits.reason:
        return _searched(search, limits), ""
    found = external(kairos_command(math.inf, settings.tolerance_s), texts, domain, problem, limits.left_s)
    if found.plan is not None:
        generated, visited = search.counts
        return replace(found, generated=generated, visited=visited), "kairos"
    return _with_reason(_searched(search, limits), found), ""


def _with_reason(ours: Result, kairos: Result) -> Result:
    """The result of the search; where that reached a limit, with the reason why kairos-planner found no plan either."""
    if ours.plan is not None or ours.status == "unsolvable":
        return ours
    return replace(ours, reason=f"{ours.reason}; kairos-planner: {kairos.reason}")


def anytime(search: AnytimeSearch, limits: Limits) -> Result:
    """The best plan within the limits; prints each better one on standard error. An interrupt ends the search."""
    return _reported(_improved(search, limits), search, limits)


def _improved(search: AnytimeSearch, limits: Limits) -> Result:
    """As `anytime`, without the line at the end."""
    started = time.process_time()
    try:
        while not search.ended and not limits.reason:
            result = search.advance(limits)
            if result is not None and result.plan is not None:
                spent = f"{search.counts[0]} plans generated, {time.process_time() - started:.2f} s CPU"
                _report(search.measure, search.value, result.plan, spent)
    except KeyboardInterrupt:
        limits.interrupted = True
    return search.best or Result("limit", None, limits.reason, *search.counts)


def _report(measure: str, value: float, plan: Plan, by: str) -> None:
    print(f"{measure} {format_number(value)}, {len(plan.steps)} steps, {by}", file=sys.stderr)


def _reported(result: Result, search: AnytimeSearch, limits: Limits) -> Result:
    """The result; of one with a plan, prints why there is none better."""
    if result.plan is not None:
        why = "no plan is better" if search.ended == "proven" else search.ended or limits.why_none_better
        print(f"best plan found: {why}", file=sys.stderr)
    return result


def anytime_beside_kairos(
    texts: tuple[str, str], domain: Domain, problem: Problem, settings: Settings, limits: Limits
) -> tuple[Result, str]:
    """As `anytime`, while kairos-planner plans in its own process; the better plan by the metric.

    Without a time limit Kairos' part is its first plan.

    Returns:
      The result, and the name of the planner that found it; "" for the built-in search.
    """
    from tailor.executive.planning import AnytimeSearch, quality
    from tailor.runtime.processes.planner_process import PlannerProcess

    search = AnytimeSearch(domain, problem, settings)
    command = kairos_command(limits.limit_s, settings.tolerance_s)
    child = PlannerProcess(command, *texts, limits.limit_s + GRACE_S)
    try:
        ours = _improved(search, limits)
        decided = search.ended == "proven" or ours.status == "unsolvable"
        _await(child, decided, limits)
    finally:
        child.kill()
    answer = None if decided else linked_answer(child, domain, problem)
    theirs = None if answer is None else answer.plan
    value = math.inf if theirs is None else quality(theirs, problem)
    if theirs is None or value >= search.value:
        ours = ours if answer is None or limits.interrupted else _with_reason(ours, answer)
        return _reported(ours, search, limits), ""
    _report(search.measure, value, theirs, "by kairos-planner")
    return _reported(Result("solved", theirs, "", *search.counts), search, limits), "kairos"


def _await(child: PlannerProcess, decided: bool, limits: Limits) -> None:
    """Waits for a planner unless its answer is of no use any more; an interrupt ends the wait."""
    try:
        while not decided and child.poll() is None and not limits.interrupted:
            time.sleep(_POLL_S)
    except KeyboardInterrupt:
        limits.interrupted = True


def external(command: str, texts: tuple[str, str], domain: Domain, problem: Problem, limit_s: float) -> Result:
    """The plan of an external planner, completed by the causal links that its text omits."""
    from tailor.runtime.processes.planner_process import PlannerProcess

    child = PlannerProcess(command, *texts, limit_s)
    try:
        while child.poll() is None:
            time.sleep(_POLL_S)
    finally:
        child.kill()
    return linked_answer(child, domain, problem)


def _searched(search: Search, limits: Limits) -> Result:
    result = search.advance(limits)
    return result or Result("limit", None, limits.reason, *search.counts)
