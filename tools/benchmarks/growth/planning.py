"""Growth of planning: CPU time to the first plan against its number of steps."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from tailor.tools.benchmarks.growth.curve import Curve
from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.benchmarks.planning import read, texts
from tailor.tools.benchmarks.planning_scale import CUPS, measured, problem_text, steps_by


def curves(quick: bool) -> Iterator[Curve]:
    """Cups from one table to another: four steps each."""
    points = [_point(cups) for cups in (CUPS[:-1] if quick else CUPS)]
    yield Curve("first plan", "steps of the plan", "CPU time, s", points, 2.0)


def _point(cups: int) -> tuple[float, float]:
    problem = read(texts("kitchen-s1")[0], problem_text(cups))
    found = measured(partial(steps_by, problem, "auto"))
    if found is None:
        raise NoMeasurement(f"no plan for {cups} cups")
    return found
