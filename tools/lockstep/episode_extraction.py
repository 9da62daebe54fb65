"""Cuts episodes of single actions out of what an executive said: recordings of real runs, or whole runs in lock-step.

An episode begins where an action got its last goal: one that was changed on the way is a new task from there on.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.values import Array
from tailor.models.episodes.episodes import UNOBSERVED, Episode
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import (
    ActionFinished,
    ExecStatus,
    InstantiatedAction,
    JointState,
    Message,
    Odometry,
    Subgoals,
)
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.tools.lockstep.action_run import sampler_of
from tailor.tools.lockstep.samplers.soccer import COLLIDED_M

MIN_TICKS = 3


@dataclass(slots=True)
class _Running:
    """An action while it is read: its goal, and the believed states since it got that goal."""

    index: int
    said: InstantiatedAction
    action: Action
    goal: Array
    ticks: list[Array] = field(default_factory=list)
    motions: list[Message | None] = field(default_factory=list)  # at each tick; None: not told
    begun_s: float = 0.0  # after the action's start
    ball: tuple[float, float] | None = None
    collided: bool = False


@dataclass(slots=True)
class EpisodeExtractor:
    """Reads messages in order; `cut` holds (data set's action, episode) as they end."""

    domain: Domain
    cut: list[tuple[str, Episode]] = field(default_factory=list)
    _newest: Subgoals | None = None
    _running: _Running | None = None
    _motion: Message | None = None  # the newest: the truth, or what the sensors say where nobody tells it

    def read(self, messages: Iterable[Message]) -> list[tuple[str, Episode]]:
        """Episodes in these messages, by the action whose duration model they teach."""
        for message in messages:
            match message:
                case Subgoals():
                    self._newest = message
                    self._changed(message)
                case ExecStatus() if message.action:
                    self._tick(message)
                case SoccerGroundTruth():
                    self._motion = message
                    self._see(message)
                case JointState():
                    self._motion = message
                case Odometry() if not isinstance(self._motion, SoccerGroundTruth):
                    self._motion = message
                case ActionFinished():
                    self._finish(message)
        return self.cut

    def _tick(self, status: ExecStatus) -> None:
        if self._running is None or self._running.index != status.action_index:
            self._running = self._begin(status)
        run = self._running
        if run is not None:
            if not run.ticks:
                run.begun_s = status.action_elapsed_s
            run.ticks.append(self._arguments(run, status))
            run.motions.append(self._motion)

    def _begin(self, status: ExecStatus) -> _Running | None:
        if self._newest is None or not self._newest.actions or self._newest.actions[0].action != status.action:
            return None
        if status.action not in self.domain.actions:
            known = ", ".join(self.domain.actions)
            raise UsageError(f"action '{status.action}' is recorded, expected those of {self.domain.robot}: {known}")
        said, action = self._newest.actions[0], self.domain.actions[status.action]
        return _Running(status.action_index, said, action, _goal(action, said))

    def _changed(self, subgoals: Subgoals) -> None:
        run = self._running
        if run is None or not subgoals.actions:
            return
        said = subgoals.actions[0]
        same = (said.action, said.step, said.asserted) == (run.said.action, run.said.step, run.said.asserted)
        if same and not np.allclose(_goal(run.action, said), run.goal, atol=1e-6):
            run.said, run.goal, run.ticks, run.motions = said, _goal(run.action, said), [], []

    def _arguments(self, run: _Running, status: ExecStatus) -> Array:
        """The controller's arguments with the believed state in place of the start, as instantiation tells it."""
        names = (name.split(" ")[0] for name in self.domain.belief_names)
        believed = dict(zip(names, status.belief, strict=True))
        values = np.array([parameter.value for parameter in run.said.parameters])
        from_ball = _starts_at_ball(run.action, values)
        for k, parameter in enumerate(run.action.parameters):
            if parameter.argument == 0:
                name = f"ball_{parameter.name}" if from_ball and parameter.name in ("x", "y") else parameter.name
                values[k] = believed[name]
        arguments = run.action.arguments(values[None, :])[0]
        return np.concatenate([arguments[: len(arguments) // 2], run.goal[len(arguments) // 2 :]])

    def _see(self, truth: SoccerGroundTruth) -> None:
        run = self._running
        if run is None:
            return
        run.ball = run.ball or (truth.ball_x, truth.ball_y)
        run.collided = run.collided or math.dist(run.ball, (truth.ball_x, truth.ball_y)) > COLLIDED_M

    def _finish(self, finished: ActionFinished) -> None:
        run, self._running = self._running, None
        if run is None or len(run.ticks) < MIN_TICKS or finished.outcome == "aborted":
            return
        failure = "" if finished.outcome == "done" else finished.reason
        if not run.action.success_model or run.ball is None:  # nobody watched the ball
            failure = failure or UNOBSERVED
        elif run.collided:
            failure = "collision"
        ticks = np.stack(run.ticks)
        duration_s = finished.actual_s - run.begun_s
        done = finished.outcome == "done"
        work_j = self._work(run.motions)
        episode = Episode(len(self.cut), ticks[0], ticks, duration_s, not failure, failure, done, work_j)
        self.cut.append((run.action.duration_model.split("/", maxsplit=1)[0], episode))

    def _work(self, motions: list[Message | None]) -> Array | None:
        """Joules of the drives from each tick to the next; None where a motion was not told."""
        if None in motions:
            return None
        told = sampler_of(self.domain).work_j
        work_j = np.array([*(told(a, b) for a, b in itertools.pairwise(motions) if a and b), 0.0])
        return work_j if np.isfinite(work_j).all() else None


def _goal(action: Action, said: InstantiatedAction) -> Array:
    values = np.array([[parameter.value for parameter in said.parameters]])
    return action.arguments(values)[0]


def _starts_at_ball(action: Action, values: Array) -> bool:
    """Whether the start is the ball's place: the controller then takes another pose than the parameters say."""
    half = len(values) // 2
    return not np.allclose(action.arguments(values[None, :])[0, :half], values[:half])
