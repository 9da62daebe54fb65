"""Growth of planning: CPU time to the first plan against its number of steps."""

from __future__ import annotations

import time
from collections.abc import Iterator

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import Search, Settings
from tailor.tools.benchmarks.growth.curve import Curve
from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.benchmarks.planning import UNLIMITED, read, texts
from tailor.tools.benchmarks.planning_scale import CUPS, problem_text


def curves(quick: bool) -> Iterator[Curve]:
    """Cups from one table to another: four steps each."""
    points = [_point(cups) for cups in (CUPS[:-1] if quick else CUPS)]
    yield Curve("first plan", "steps of the plan", "CPU time, s", points, 2.0)


def _point(cups: int) -> tuple[float, float]:
    problem = read(texts("kitchen-s1")[0], problem_text(cups))
    began = time.process_time()
    result = Search(problem.domain, problem, Settings()).advance(CheckBudget(UNLIMITED))
    if result is None or result.plan is None:
        raise NoMeasurement(f"no plan for {cups} cups")
    return len(result.plan.steps), time.process_time() - began
