"""Sources of a plan for the command line: the built-in search, an external planner, or one after the other."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field, replace

from tailor.executive.planning import Domain, Problem, Result, Search, Settings
from tailor.schemas.errors import UsageError

DURATIVE_HEAD_START = 500  # plans refined by the built-in search, about 0.1 s: short problems keep its plans
_POLL_S = 0.002  # period of polling an external planner


@dataclass(slots=True)
class _Budget:
    """Grants work until a deadline of wall time, or until the search has refined so many plans."""

    deadline: float
    search: Search
    plans: float = math.inf
    granted: int = field(default=0)

    def spent(self) -> bool:
        """See `Budget`."""
        self.granted += 1
        return self.search.counts[1] >= self.plans or time.monotonic() >= self.deadline


def built_in(domain: Domain, problem: Problem, settings: Settings, limit_s: float) -> Result:
    """The result of the built-in search."""
    search = Search(domain, problem, settings)
    return _searched(search, time.monotonic() + limit_s, limit_s)


def with_kairos(
    texts: tuple[str, str], domain: Domain, problem: Problem, settings: Settings, limit_s: float
) -> tuple[Result, str]:
    """The built-in search with a head start, then kairos-planner's first plan, then the rest of the search.

    Returns:
      The result, and the name of the planner that found it; "" for the built-in search.
    """
    search, deadline = Search(domain, problem, settings), time.monotonic() + limit_s
    result = search.advance(_Budget(deadline, search, DURATIVE_HEAD_START))
    if result is None or result.status in ("limit", "unsupported"):
        found = external("kairos", texts, domain, problem, deadline - time.monotonic())
        if found.plan is not None:
            generated, visited = search.counts
            return replace(found, generated=generated, visited=visited), "kairos"
        result = _searched(search, deadline, limit_s)
    return result, ""


def external(command: str, texts: tuple[str, str], domain: Domain, problem: Problem, limit_s: float) -> Result:
    """The plan of an external planner, completed by the causal links that its text omits."""
    from tailor.executive.planning import completed, parse_plan
    from tailor.runtime.processes.planner_process import PlannerProcess

    child = PlannerProcess(command, *texts, limit_s)
    try:
        while (answer := child.poll()) is None:
            time.sleep(_POLL_S)
    finally:
        child.kill()
    try:
        plan = completed(parse_plan(answer.output), domain, problem)
    except UsageError as error:
        return Result("limit", None, f"{answer.reason}; {error}", 0, 0)
    if isinstance(plan, str):
        return Result("limit", None, f"the planner's plan is unsound: {plan}", 0, 0)
    return Result("solved", plan, "", 0, 0)


def _searched(search: Search, deadline: float, limit_s: float) -> Result:
    result = search.advance(_Budget(deadline, search))
    return result or Result("limit", None, f"no plan within {limit_s:g} s", *search.counts)
