"""Whole runs in lock-step: the executive's core and a simulated world in one process, faster than real time.

Core, driver and guard are the same as in a live run over the bus.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

from tailor.executive.core.state import Inputs, Output, State, initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import PERIOD_NS, Context
from tailor.executive.interfaces.budget import Budget, CheckBudget
from tailor.executive.replay import RecordedTick
from tailor.runtime.budget import ClockBudget
from tailor.schemas.messages import ActionFinished, ExecStatus, Message, Sample, Subgoals
from tailor.simnodes.world import World
from tailor.tools.lockstep.blame import blamed_on_run
from tailor.tools.lockstep.driver_link import DriverLink, Transport

CHECKS_PER_TICK = 300  # with which nearly every search ends in its tick; 60 ms of CPU grant 10 to 120
DELIBERATION = partial(CheckBudget, CHECKS_PER_TICK)
SENDER = "00" * 16

TickObserver = Callable[[RecordedTick, tuple[Output, ...]], None]  # receives inputs and outputs of each tick


@dataclass(slots=True)
class Run:
    """One run of the executive; times in seconds since its start."""

    result: str = "failed: time limit"
    started_s: float = math.nan  # first action
    ended_s: float = math.nan  # last action
    finished: list[ActionFinished] = field(default_factory=list)
    subgoals: list[Subgoals] = field(default_factory=list)
    truth: list[Message] = field(default_factory=list)
    status: list[ExecStatus] = field(default_factory=list)
    messages: list[Message] = field(default_factory=list)  # outputs of the core and ground truth, in order

    @property
    def achieved(self) -> bool:
        """Whether the goal was reached."""
        return self.result == "achieved"

    @property
    def duration_s(self) -> float:
        """From the start of the first action to the end of the last one; the paper's t of an episode."""
        return self.ended_s - self.started_s


def cpu_budget(limit_ns: int) -> Budget:
    """The budget of a tick that begins now: so much CPU time of this thread, as live; a run does not repeat exactly."""
    return ClockBudget(time.thread_time_ns() + limit_ns, time.thread_time_ns)


def run_lockstep(
    context: Context,
    world: World,
    *,
    limit_s: float = 90.0,
    new_budget: Callable[[], Budget] = DELIBERATION,
    on_tick: TickObserver | None = None,
    transport: Transport | None = None,
) -> Run:
    """Pursue the scenario's goal until it is achieved, has failed, or the time limit is reached.

    Args:
      context: Built with sender `SENDER`.
      world: At its start.
      limit_s: Limit of the simulated time.
      new_budget: Returns the budget of a tick's deliberation; called at the start of each tick.
      on_tick: Called after each tick.
      transport: Passes readings on as the bus does; None: the core receives the very values.

    Returns:
      Result, actions, subgoals, ground truth and all messages of the run.
    """
    with blamed_on_run(context.domain.name):
        return _run(context, DriverLink(context.domain, world, SENDER, transport), limit_s, new_budget, on_tick)


def _run(
    context: Context, link: DriverLink, limit_s: float, new_budget: Callable[[], Budget], on_tick: TickObserver | None
) -> Run:
    run, state = Run(), initial_state(context)
    goal, samples = context.problem.goal_text, _advance(link, 0, run)
    for tick in range(1, int(limit_s * 1e9) // PERIOD_NS):
        now_ns = tick * PERIOD_NS
        inputs, budget = Inputs(samples, goal), new_budget()
        state, outputs = step(context, state, now_ns, inputs, budget)
        if on_tick is not None:
            on_tick(RecordedTick(tick, now_ns, inputs, budget.granted), outputs)
        goal = ""
        _add(run, state, outputs, now_ns / 1e9)
        if not state.task.active:
            run.result = state.task.result_text
            break
        link.send(outputs, now_ns, tick)
        samples = _advance(link, now_ns, run)
    return run


def _advance(link: DriverLink, now_ns: int, run: Run) -> tuple[Sample, ...]:
    samples, truth = link.advance(now_ns)
    run.truth.extend(truth)
    run.messages.extend(truth)
    return samples


def _add(run: Run, state: State, outputs: tuple[Output, ...], now_s: float) -> None:
    if state.task.running is not None and math.isnan(run.started_s):
        run.started_s = now_s
    for output in outputs:
        message = output.message
        run.messages.append(message)
        if isinstance(message, ActionFinished):
            run.finished.append(message)
            run.ended_s = now_s
        elif isinstance(message, Subgoals):
            run.subgoals.append(message)
        elif isinstance(message, ExecStatus):
            run.status.append(message)
