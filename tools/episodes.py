"""Whole episodes in lock-step: the executive's core and a simulated body joined in one process, as fast as it goes.

The same core as live; the driver's part is played by the same guard as on the bus.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from executive.budget import CheckBudget
from executive.core.context import PERIOD_NS, Context
from executive.core.state import Inputs, Output, State, initial_state
from executive.core.step import step
from schemas.messages import ActionFinished, DriverState, ExecStatus, Sample, SimTruth, Subgoals
from schemas.topics import key_of
from simnodes.body import Body, Reading

NOISE_STREAM = 1  # of the seed; the scenario is drawn from stream 0
CHECKS_PER_TICK = 300  # what a quiet machine grants in 60 ms, roughly
SENDER = "00" * 16


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happens to the world by itself, e.g. the ball is kicked."""

    at_s: float
    place: Mapping[str, float]


@dataclass(slots=True)
class Episode:
    """What happened; times in seconds since the start."""

    result: str = "failed: time limit"
    started_s: float = float("nan")  # first action
    ended_s: float = float("nan")  # last action
    finished: list[ActionFinished] = field(default_factory=list)
    subgoals: list[Subgoals] = field(default_factory=list)
    truth: list[SimTruth] = field(default_factory=list)
    status: list[ExecStatus] = field(default_factory=list)

    @property
    def achieved(self) -> bool:
        """Whether the goal was reached."""
        return self.result == "achieved"

    @property
    def duration_s(self) -> float:
        """From the start of the first action to the end of the last one; the paper's t of an episode."""
        return self.ended_s - self.started_s


def run_episode(
    context: Context,
    body: Body,
    start: Mapping[str, float],
    seed: int,
    events: Sequence[Event] = (),
    limit_s: float = 90.0,
) -> Episode:
    """Run the scenario's goal from `start` until it is achieved, has failed, or `limit_s` of simulated time is over.

    Args:
      context: Composed with sender `SENDER`.
      body: Reset here; its noise is drawn from stream 1 of `seed`.
      start: Start state, as `Body.reset` takes it.
      events: What happens on the way.
    """
    body.reset(np.random.default_rng([seed, NOISE_STREAM]), start)
    episode, state, pending = Episode(), initial_state(context), sorted(events, key=lambda e: e.at_s)
    goal, readings = context.problem.goal_text, body.advance(PERIOD_NS)
    for tick in range(1, int(limit_s * 1e9) // PERIOD_NS):
        now_ns = tick * PERIOD_NS
        inputs = Inputs(_samples(context.domain.robot, readings, now_ns, tick), goal)
        state, outputs = step(context, state, now_ns, inputs, CheckBudget(CHECKS_PER_TICK))
        goal = ""
        _note(episode, state, outputs, now_ns / 1e9)
        if not state.task.active:
            episode.result = state.task.result
            break
        while pending and pending[0].at_s <= now_ns / 1e9:
            body.place(pending.pop(0).place)
        body.command(state.command)
        readings = body.advance(PERIOD_NS)
        episode.truth.append(body.truth())
    return episode


def _samples(robot: str, readings: Sequence[Reading], now_ns: int, tick: int) -> tuple[Sample, ...]:
    """The newest reading of each topic, as a ring of depth one would hand it over, and an armed driver."""
    newest = {reading.topic: reading for reading in readings if reading.topic != "truth"}
    samples = [Sample(key_of(r.topic, robot), r.message, r.time_ns, tick) for r in newest.values()]
    armed = DriverState(now_ns, "armed", "", 1, SENDER, 0)
    samples.append(Sample(key_of("driver", robot), armed, now_ns, tick))
    return tuple(sorted(samples, key=lambda sample: sample.arrival_ns))


def _note(episode: Episode, state: State, outputs: tuple[Output, ...], now_s: float) -> None:
    if state.task.running is not None and np.isnan(episode.started_s):
        episode.started_s = now_s
    for output in outputs:
        message = output.message
        if isinstance(message, ActionFinished):
            episode.finished.append(message)
            episode.ended_s = now_s
        elif isinstance(message, Subgoals):
            episode.subgoals.append(message)
        elif isinstance(message, ExecStatus):
            episode.status.append(message)
