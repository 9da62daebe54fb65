"""Prints the result of `tailor plan` in one of its forms."""

from __future__ import annotations

import argparse
import json
import sys
from typing import Any

from tailor.executive.planning import Problem, Result, format_links, format_plan
from tailor.executive.planning.pddl.syntax.errors import shortened
from tailor.tools.cli.plain_text import plain


def print_result(args: argparse.Namespace, result: Result, problem: Problem, cpu_ms: float) -> None:
    """Prints the plan, or on standard error why there is none."""
    plan = result.plan
    if args.json:
        print(json.dumps(as_json(result, problem.name, cpu_ms)))
    elif plan is None:
        outcome = "no plan exists" if result.status == "unsolvable" else "no plan found"
        reason = plain(result.reason)  # quotes what an external planner printed
        print(shortened(f"{problem.name}: {outcome}: {reason}"), file=sys.stderr)
    elif args.links:
        print(format_links(plan), end="")
    elif args.dot:
        from tailor.tools.figures.plan_drawing import to_dot

        print(to_dot(plan), end="")
    elif args.svg:
        from tailor.tools.figures.plan_svg import to_svg

        print(to_svg(plan), end="")
    else:
        print(format_plan(plan), end="")


def as_json(result: Result, problem: str, cpu_ms: float) -> dict[str, Any]:
    """The result as a JSON object."""
    plan = result.plan
    return {
        "problem": problem,
        "status": result.status,
        "reason": result.reason,
        "steps": [
            {"id": s.id, "start": s.start, "action": list(s.action), "duration": s.duration}
            for s in (plan.steps if plan else ())
        ],
        "links": [
            {"producer": x.producer, "literal": str(x.literal), "consumer": "goal" if x.consumer < 0 else x.consumer}
            for x in (plan.links if plan else ())
        ],
        "orderings": [list(pair) for pair in (plan.orderings if plan else ())],
        "makespan": plan.makespan if plan else None,
        "generated": result.generated,
        "visited": result.visited,
        "cpu_ms": round(cpu_ms, 3),
    }
