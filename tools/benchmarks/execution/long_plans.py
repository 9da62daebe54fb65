"""Benchmark of the executive's ticks while it executes a long plan: 10 to 50 cups, 4 steps a cup, in lock-step.

A tick's time is the CPU time of the core and of the codec, with the live budget of deliberation in CPU time. Garbage is
collected between the ticks, as in the live loop.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field

from rich.console import Console
from rich.table import Table

from tailor.executive.core.state import Inputs, initial_state
from tailor.executive.core.step import control, deliberate
from tailor.executive.deliberation.context import Context, Settings, make_context
from tailor.executive.interfaces.domain import Scenario
from tailor.executive.shell import DELIBERATION_NS
from tailor.runtime.budget import ClockBudget
from tailor.runtime.gc_freeze import gc_disabled
from tailor.runtime.realtime import collect_garbage
from tailor.schemas.codec import encode, prime
from tailor.schemas.messages import DriverState, Odometry, PlanReport, Sample
from tailor.tools.benchmarks.execution.porter import MODELS, PLACES_M, Porter
from tailor.tools.benchmarks.planning import texts
from tailor.tools.benchmarks.planning_scale import goal_text, problem_text

PERIOD_NS = 100_000_000
SENDER, DRIVER = "ab" * 16, "cd" * 16
MAX_TICKS_PER_STEP = 20
CUPS = (10, 20, 40, 50)


@dataclass(slots=True)
class Course:
    """What one run took, tick by tick."""

    times_ms: list[float] = field(default_factory=list)
    largest_plan: int = 0  # bytes of the largest message that publishes a plan
    control_ms: list[float] = field(default_factory=list)  # the part before the command
    idle: int = 0  # ticks without a running action between two actions, besides those in which one ends
    steps: int = 0
    result: str = ""


def run(console: Console, quick: bool) -> None:
    """Print one row for each length."""
    title = "executing a plan: CPU ms of the longest tick, of which 60 are for deliberation"
    table = Table(title=title, box=None)
    for column in ("steps", "result", "ticks", "without action", "longest", "95 %", "control", "plan message"):
        table.add_column(column, justify="right")
    for cups in CUPS[:2] if quick else CUPS:
        course = drive(cups, Settings())
        times = sorted(course.times_ms)
        numbers = (times[-1], times[round(0.95 * (len(times) - 1))], max(course.control_ms))
        cells = (str(course.idle), *(f"{ms:.1f}" for ms in numbers), f"{course.largest_plan} bytes")
        table.add_row(str(course.steps), course.result, str(len(times)), *cells)
    console.print(table)


def porter_context(cups: int, settings: Settings) -> Context:
    """The executive's context for the porter with so many cups."""
    domain_text, _ = texts("kitchen-s1")
    scenario = Scenario(f"cups-{cups}", problem_text(cups), {name: {"x": x} for name, x in PLACES_M.items()})
    return make_context(Porter(domain_text), scenario, MODELS, settings, SENDER)


def drive(cups: int, settings: Settings, max_ticks: int | None = None) -> Course:
    """Run the task to its end, or for `max_ticks`; without automatic collection of garbage, as in the live loop."""
    with gc_disabled():
        return _driven(porter_context(cups, settings), cups, max_ticks or MAX_TICKS_PER_STEP * 4 * cups)


def _driven(context: Context, cups: int, max_ticks: int) -> Course:
    prime()
    course = Course()
    state, x_m = initial_state(context), 0.0
    for tick in range(1, 1 + max_ticks):
        now_ns = tick * PERIOD_NS
        inputs = Inputs(samples(now_ns, tick, x_m), goal_text(cups) if tick == 1 else "")
        started_ns = time.process_time_ns()
        state, first = control(context, state, now_ns, inputs)
        course.control_ms.append((time.process_time_ns() - started_ns) / 1e6)
        state, rest = deliberate(context, state, ClockBudget(started_ns + DELIBERATION_NS, time.process_time_ns))
        sizes = [(type(output.message), len(encode(output.message))) for output in (*first, *rest)]
        course.times_ms.append((time.process_time_ns() - started_ns) / 1e6)
        course.largest_plan = max([course.largest_plan, *(size for kind, size in sizes if kind is PlanReport)])
        collect_garbage(tick)
        x_m += 0.1 * state.command[0]
        course.idle += state.task.active and state.task.decision is None and state.task.plan is not None
        if not state.task.active:
            break
    course.steps, course.result = state.task.finished, str(state.task.result)
    return course


def samples(now_ns: int, tick: int, x_m: float) -> tuple[Sample, ...]:
    """Exact odometry, and an armed driver."""
    odometry = Odometry(now_ns, x_m, 0.0, 0.0, 0.0, 0.0)
    driver = DriverState(now_ns, "armed", "", "", 7, SENDER, 1)
    return (
        Sample("porter/odom", odometry, now_ns, 5 * tick, DRIVER),
        Sample("porter/driver", driver, now_ns, tick, DRIVER),
    )
