"""Whole episodes in lock-step: the executive's core and a simulated world joined in one process, as fast as it goes.

The same core as live, and on the robot's side the same driver and guard as on the bus.
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
from tailor.simnodes.driver_spec import declaration
from tailor.simnodes.world import Event, World

CHECKS_PER_TICK = 300  # what a quiet machine grants in 60 ms, roughly
SENDER = "00" * 16
DRIVER = "d1" * 16  # sender of what the world's side says
EPOCH = 1

Witness = Callable[[RecordedTick, tuple[Output, ...]], None]  # of what a tick was given, and what it answered
Wire = Callable[[Message], Message]  # what becomes of a reading on its way to the core


@dataclass(slots=True)
class Run:
    """What happened; times in seconds since the start."""

    result: str = "failed: time limit"
    started_s: float = math.nan  # first action
    ended_s: float = math.nan  # last action
    finished: list[ActionFinished] = field(default_factory=list)
    subgoals: list[Subgoals] = field(default_factory=list)
    truth: list[Message] = field(default_factory=list)
    status: list[ExecStatus] = field(default_factory=list)
    messages: list[Message] = field(default_factory=list)  # all that the core said, and the truth, in order

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
    witness: Witness | None = None,
    wire: Wire | None = None,
) -> Run:
    """Run the scenario's goal from `start` until it is achieved, has failed, or `limit_s` of simulated time is over.

    Args:
      context: Composed with sender `SENDER`.
      body: Reset here; its noise is drawn from stream 1 of `seed`.
      start: Start state, as `Body.reset` takes it.
      seed: Of the body's noise.
      events: What happens on the way.
      limit_s: Simulated seconds.
      checks: What each tick's deliberation is granted.
      witness: Called after each tick.
      wire: Changes every reading as the bus does; None: the core hears the very values.
    """
    link = _Link(context.domain, World(body, start, seed, events), wire)
    episode, state = Run(), initial_state(context)
    goal, samples = context.problem.goal_text, link.advance(0, episode)
    for tick in range(1, int(limit_s * 1e9) // PERIOD_NS):
        now_ns = tick * PERIOD_NS
        inputs, budget = Inputs(samples, goal), CheckBudget(checks)
        state, outputs = step(context, state, now_ns, inputs, budget)
        if witness is not None:
            witness(RecordedTick(tick, now_ns, inputs, budget.granted), outputs)
        goal = ""
        _note(episode, state, outputs, now_ns / 1e9)
        if not state.task.active:
            episode.result = state.task.result
            break
        link.take(outputs, now_ns, tick)
        samples = link.advance(now_ns, episode)
    return episode


class _Link:
    """What the bus is live: carries commands to the driver and readings back, with no delay and nothing lost."""

    def __init__(self, domain: Domain, world: World, wire: Wire | None) -> None:
        self._robot, self._sensors, self._world, self._wire = domain.robot, domain.sensors, world, wire
        self._declared = declaration(domain.robot)
        self._driver = Driver(self._declared, EPOCH)
        self._sequences: Counter[str] = Counter()  # one for each topic, as publishers number

    def take(self, outputs: Sequence[Output], now_ns: int, tick: int) -> None:
        """Hand the tick's commands and requests to the driver."""
        heard = (self._declared.command_topic, "arm_request")
        samples = [
            Sample(key_of(o.topic, self._robot), o.message, now_ns, tick, SENDER) for o in outputs if o.topic in heard
        ]
        self._driver.take(samples, {}, now_ns)
        if any(not isinstance(sample.message, ArmRequest) for sample in samples):
            self._world.begin()

    def advance(self, now_ns: int, episode: Run) -> tuple[Sample, ...]:
        """One period of the world under the guard's output; the newest reading of each topic and the driver's state."""
        self._world.body.command(self._driver.guard.output(now_ns))
        newest: dict[str, Reading] = {}
        for reading in self._world.advance(PERIOD_NS):
            newest[reading.topic] = reading
        for topic in [topic for topic in newest if TOPICS[topic].source == "simulator"]:
            truth = newest.pop(topic).message
            episode.truth.append(truth)
            episode.messages.append(truth)
        samples = [self._sample(r.topic, r.message, r.time_ns) for r in newest.values() if r.topic in self._sensors]
        after_ns = now_ns + PERIOD_NS
        driver = self._driver.state(after_ns, after_ns)
        if driver is not None:
            samples.append(self._sample("driver", driver, after_ns))
        return tuple(sorted(samples, key=lambda sample: sample.arrival_ns))

    def _sample(self, topic: str, message: Message, arrival_ns: int) -> Sample:
        heard = message if self._wire is None else self._wire(message)
        self._sequences[topic] += 1
        return Sample(key_of(topic, self._robot), heard, arrival_ns, self._sequences[topic], DRIVER)


def _note(episode: Run, state: State, outputs: tuple[Output, ...], now_s: float) -> None:
    if state.task.running is not None and math.isnan(episode.started_s):
        episode.started_s = now_s
    for output in outputs:
        message = output.message
        episode.messages.append(message)
        if isinstance(message, ActionFinished):
            episode.finished.append(message)
            episode.ended_s = now_s
        elif isinstance(message, Subgoals):
            episode.subgoals.append(message)
        elif isinstance(message, ExecStatus):
            episode.status.append(message)
