"""Sources of a plan for the command line: the built-in search, an external planner, or one after the other."""

from __future__ import annotations

import math
import sys
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from tailor.executive.planning import Domain, Problem, Result, Search, Settings
from tailor.executive.planning.pddl.errors import shortened
from tailor.schemas.errors import UsageError
from tailor.tools.cli.plan_limits import DURATIVE_HEAD_START, Limits

if TYPE_CHECKING:
    from tailor.executive.planning import AnytimeSearch
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
    if result is None or result.status in ("limit", "unsupported"):
        found = external("kairos", texts, domain, problem, limits.left_s)
        if found.plan is not None:
            generated, visited = search.counts
            return replace(found, generated=generated, visited=visited), "kairos"
        result = _searched(search, limits)
    return result, ""


def anytime(search: AnytimeSearch, limits: Limits) -> Result:
    """The best plan within the limits; prints each better one on standard error. An interrupt ends the search."""
    started = time.process_time()
    try:
        while not search.ended and not limits.reason:
            result = search.advance(limits)
            if result is not None and result.plan is not None:
                print(
                    f"{search.measure} {search.value:g}, {len(result.plan.steps)} steps, {search.counts[0]} plans "
                    f"generated, {time.process_time() - started:.2f} s CPU",
                    file=sys.stderr,
                )
    except KeyboardInterrupt:
        limits.interrupted = True
    if search.best is None:
        return Result("limit", None, limits.reason, *search.counts)
    if search.best.plan is not None:
        why = "no plan is better" if search.ended == "proven" else search.ended or limits.why_none_better
        print(f"best plan found: {why}", file=sys.stderr)
    return search.best


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
    limited = math.isfinite(limits.limit_s)
    child = PlannerProcess(f"kairos:{limits.limit_s:g}" if limited else "kairos", *texts, limits.limit_s + GRACE_S)
    try:
        ours = anytime(search, limits)
        if search.ended == "proven" or ours.status == "unsolvable":
            return ours, ""
        while child.poll() is None and not limits.interrupted:
            time.sleep(_POLL_S)
    finally:
        child.kill()
    theirs = _linked(child, domain, problem)
    if theirs.plan is None or quality(theirs.plan, problem) >= search.value:
        return ours, ""
    generated, visited = search.counts
    return replace(theirs, generated=generated, visited=visited), "kairos"


def external(command: str, texts: tuple[str, str], domain: Domain, problem: Problem, limit_s: float) -> Result:
    """The plan of an external planner, completed by the causal links that its text omits."""
    from tailor.runtime.processes.planner_process import PlannerProcess

    child = PlannerProcess(command, *texts, limit_s)
    try:
        while child.poll() is None:
            time.sleep(_POLL_S)
    finally:
        child.kill()
    return _linked(child, domain, problem)


def _linked(child: PlannerProcess, domain: Domain, problem: Problem) -> Result:
    """The plan of an external planner that has ended."""
    from tailor.executive.planning import completed, parse_plan

    answer = child.poll()
    assert answer is not None
    try:
        plan = completed(parse_plan(answer.output), domain, problem)
    except UsageError as error:
        return Result("limit", None, f"{answer.reason}{_verdict(answer.output) or f'; {error}'}", 0, 0)
    if isinstance(plan, str):
        return Result("limit", None, f"the planner's plan is unsound: {plan}", 0, 0)
    return Result("solved", plan, "", 0, 0)


def _verdict(output: str) -> str:
    """What a planner states instead of a plan, such as VHPOP's "no plan"; empty if it printed steps, or nothing."""
    lines = [line for line in map(str.strip, output.splitlines()) if line and not line.startswith(";")]
    return f": '{shortened(lines[-1])}'" if lines and "(" not in output else ""


def _searched(search: Search, limits: Limits) -> Result:
    result = search.advance(limits)
    return result or Result("limit", None, limits.reason, *search.counts)
