"""Whole runs in lock-step: the executive's core and a simulated world in one process, faster than real time.

Core, driver and guard are the same as in a live run over the bus.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from tailor.executive.core.context import PERIOD_NS, Context
from tailor.executive.core.state import Inputs, Output, State, initial_state
from tailor.executive.core.step import step
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.domain import Domain
from tailor.executive.replay import RecordedTick
from tailor.schemas.messages import ActionFinished, ArmRequest, ExecStatus, Message, Sample, Subgoals
from tailor.schemas.topics import TOPICS, key_of
from tailor.simnodes.body import Body, Reading
from tailor.simnodes.driver import Driver
from tailor.simnodes.driver_spec import shipped_driver_spec
from tailor.simnodes.world import Event, World

CHECKS_PER_TICK = 300  # about what an idle machine grants in 60 ms
SENDER = "00" * 16
DRIVER = "d1" * 16  # sender of the driver's messages
EPOCH = 1

TickObserver = Callable[[RecordedTick, tuple[Output, ...]], None]  # receives inputs and outputs of each tick
Transport = Callable[[Message], Message]  # returns a reading as the core receives it


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


def run_lockstep(
    context: Context,
    body: Body,
    start: Mapping[str, float],
    seed: int,
    events: Sequence[Event] = (),
    limit_s: float = 90.0,
    checks: int = CHECKS_PER_TICK,
    on_tick: TickObserver | None = None,
    transport: Transport | None = None,
) -> Run:
    """Pursue the scenario's goal from `start` until it is achieved, has failed, or the time limit is reached.

    Args:
      context: Built with sender `SENDER`.
      body: Reset here; its noise is drawn from stream 1 of `seed`.
      start: Start state, as `Body.reset` takes it.
      seed: Seed of the body's noise.
      events: Disturbances during the run.
      limit_s: Limit of the simulated time.
      checks: Budget of each tick's deliberation.
      on_tick: Called after each tick.
      transport: Passes readings on as the bus does; None: the core receives the very values.

    Returns:
      Result, actions, subgoals, ground truth and all messages of the run.
    """
    link = _Link(context.domain, World(body, start, seed, events), transport)
    run, state = Run(), initial_state(context)
    goal, samples = context.problem.goal_text, link.advance(0, run)
    for tick in range(1, int(limit_s * 1e9) // PERIOD_NS):
        now_ns = tick * PERIOD_NS
        inputs, budget = Inputs(samples, goal), CheckBudget(checks)
        state, outputs = step(context, state, now_ns, inputs, budget)
        if on_tick is not None:
            on_tick(RecordedTick(tick, now_ns, inputs, budget.granted), outputs)
        goal = ""
        _add(run, state, outputs, now_ns / 1e9)
        if not state.task.active:
            run.result = state.task.result_text
            break
        link.send(outputs, now_ns, tick)
        samples = link.advance(now_ns, run)
    return run


class _Link:
    """Replaces the bus: carries commands to the driver and readings back, without delay or loss."""

    def __init__(self, domain: Domain, world: World, transport: Transport | None) -> None:
        self._robot, self._sensors, self._world, self._transport = domain.robot, domain.sensors, world, transport
        self._spec = shipped_driver_spec(domain.robot)
        self._driver = Driver(self._spec, EPOCH, leave=SENDER)
        self._sequences: Counter[str] = Counter()  # by topic, as publishers count

    def send(self, outputs: Sequence[Output], now_ns: int, tick: int) -> None:
        """Pass the tick's commands and requests to the driver."""
        received = (*self._spec.command_topics, "self_arm")
        samples = [
            Sample(key_of(o.topic, self._robot), o.message, now_ns, tick, SENDER)
            for o in outputs
            if o.topic in received
        ]
        self._driver.take(samples, {}, now_ns)
        if any(not isinstance(sample.message, ArmRequest) for sample in samples):
            self._world.begin()

    def advance(self, now_ns: int, run: Run) -> tuple[Sample, ...]:
        """Advance the world by one period; return the newest reading of each topic and the driver's state."""
        self._world.body.command(self._driver.guard.output(now_ns))
        newest: dict[str, Reading] = {}
        for reading in self._world.advance(PERIOD_NS):
            newest[reading.topic] = reading
            self._sequences[reading.topic] += 1
        for topic in [topic for topic in newest if TOPICS[topic].source == "simulator"]:
            truth = newest.pop(topic).message
            run.truth.append(truth)
            run.messages.append(truth)
        samples = [self._sample(r.topic, r.message, r.time_ns) for r in newest.values() if r.topic in self._sensors]
        after_ns = now_ns + PERIOD_NS
        driver = self._driver.state(after_ns, after_ns)
        if driver is not None:
            self._sequences["driver"] += 1
            samples.append(self._sample("driver", driver, after_ns))
        return tuple(sorted(samples, key=lambda sample: sample.arrival_ns))

    def _sample(self, topic: str, message: Message, arrival_ns: int) -> Sample:
        received = message if self._transport is None else self._transport(message)
        return Sample(key_of(topic, self._robot), received, arrival_ns, self._sequences[topic], DRIVER)


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
