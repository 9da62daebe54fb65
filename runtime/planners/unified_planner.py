"""Prints a plan of one of unified-planning's engines for a PDDL problem: ENGINE DOMAIN PROBLEM.

ENGINE alone prints why that engine is no planner, and nothing if it is one.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any


def main(engine: str, domain: str, problem: str) -> int:
    """Plan and print; 0 with a plan, 1 without, with the reason as last line: the reader of plans quotes it.

    Args:
      engine: Name of the engine, e.g. "pyperplan".
      domain: Path of the domain.
      problem: Path of the problem.
    """
    from unified_planning.io import PDDLReader
    from unified_planning.shortcuts import OneshotPlanner, get_environment

    get_environment().credits_stream = None
    task, reason = None, _no_planner(engine)
    if not reason:
        try:
            task = PDDLReader().parse_problem(domain, problem)
        except Exception as error:  # whatever the reader, and the parser that it uses, raise
            reason = f"unified-planning does not read the problem: {' '.join(str(error).split())}"
    reason = reason or _unsupported(engine, task)
    if reason:
        print(reason)
        return 1
    with OneshotPlanner(name=engine) as planner:
        result = planner.solve(task)
    if result.plan is None:
        print(result.status.name.lower().replace("_", " "))
        return 1
    for line in _lines(result.plan, task):
        print(line)
    return 0


def check(engine: str) -> int:
    """Print why an engine is no planner, with those that are installed; 0 if it is one, else 2."""
    from unified_planning.shortcuts import get_environment

    reason = _no_planner(engine)
    if not reason:
        return 0
    factory = get_environment().factory
    planners = [name for name in factory.engines if factory.engine(name).is_oneshot_planner()]
    installed = f"one of: {', '.join(planners)}" if planners else "a planner, e.g. after: pip install up-pyperplan"
    print(f"{reason}, expected {installed}")
    return 2


def _no_planner(engine: str) -> str:
    """Why an engine cannot plan at all; empty if it can."""
    from unified_planning.shortcuts import get_environment

    factory = get_environment().factory
    if engine not in factory.engines:
        return f"no engine {engine} is installed"
    return "" if factory.engine(engine).is_oneshot_planner() else f"the engine {engine} is no planner"


def _unsupported(engine: str, task: Any) -> str:
    """What a task has that an engine does not plan with; some engines end by an assertion instead. Empty if nothing."""
    from unified_planning.shortcuts import get_environment

    kind = get_environment().factory.engine(engine)
    if kind.supports(task.kind):
        return ""
    lacking = sorted(task.kind.features - kind.supported_kind().features)
    return f"the engine {engine} does not plan with {', '.join(lacking).lower().replace('_', ' ')}"


def _lines(plan: Any, task: Any) -> Iterator[str]:
    """The lines of the competitions' format: `(action args)`, or `START: (action args) [DURATION]`."""
    from unified_planning.plans import PlanKind

    if plan.kind is PlanKind.TIME_TRIGGERED_PLAN:
        for start, action, duration in plan.timed_actions:
            yield f"{float(start):.6f}: {_action(action)} [{float(duration or 0):.6f}]"
        return
    if plan.kind is not PlanKind.SEQUENTIAL_PLAN:
        plan = plan.convert_to(PlanKind.SEQUENTIAL_PLAN, task)
    for action in plan.actions:
        yield _action(action)


def _action(instance: Any) -> str:
    return f"({' '.join([instance.action.name, *map(str, instance.actual_parameters)])})"


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) > 2 else check(*sys.argv[1:]))
