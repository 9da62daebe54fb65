"""Extracts episodes of single actions from the messages of whole runs: live recordings, or runs in lock-step.

An episode begins where an action received its last goal: a goal that changes on the way starts a new task.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from tailor.executive.interfaces.action import Action, unchanged
from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.values import Array
from tailor.models.episodes.episodes import UNOBSERVED, Episode
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import ActionFinished, Contexts, ExecStatus, InstantiatedAction, Message, Subgoals
from tailor.schemas.reason_text import reason_text
from tailor.tools.lockstep.task_sampler import TaskSampler, sampler_of

MIN_TICKS = 3


@dataclass(slots=True)
class _Running:
    """An action while it is read: its goal, and the believed states since it received that goal."""

    index: int
    instance: InstantiatedAction
    action: Action
    goal: Array
    in_context: bool  # whether it was decided beside objects of its context
    ticks: list[Array] = field(default_factory=list)
    motions: list[Message | None] = field(default_factory=list)  # at each tick; None: not recorded
    begun_s: float = 0.0  # after the action's start
    start: dict[str, float] | None = None  # of the ground truth; None: not recorded
    failure: str = ""  # that the ground truth shows


class EpisodeExtractor:
    """Reads the messages of one executive in order and collects the episodes as they end.

    Args:
      domain: Domain of the recorded robot.

    Attributes:
      episodes: Name of the duration model's data set, and the episode.
    """

    def __init__(self, domain: Domain) -> None:
        self.episodes: list[tuple[str, Episode]] = []
        self._domain = domain
        self._sampler: TaskSampler = sampler_of(domain)
        self._subgoals: Subgoals | None = None  # the newest
        self._contexts: Contexts | None = None  # the newest
        self._running: _Running | None = None
        self._motion: Message | None = None  # the newest

    def read(self, messages: Iterable[Message]) -> list[tuple[str, Episode]]:
        """Read messages and return all episodes so far.

        Raises:
          UsageError: The messages name an action that the domain does not have.
        """
        for message in messages:
            self._motion = self._sampler.motion(message, self._motion)
            self._observe(message)
            match message:
                case Subgoals():
                    self._subgoals = message
                case Contexts():
                    self._contexts = message
                case ExecStatus() if message.action:
                    self._tick(message)
                case ActionFinished():
                    self._finish(message)
        return self.episodes

    def _tick(self, status: ExecStatus) -> None:
        if self._running is None or self._running.index != status.action_index:
            self._running = self._begin(status)
        elif self._subgoals is not None and self._subgoals.actions:
            self._adopt(self._running, self._subgoals.actions[0], status.action_elapsed_s)
        run = self._running
        if run is not None:
            if not run.ticks:
                run.begun_s = status.action_elapsed_s
            run.ticks.append(self._arguments(run, status))
            run.motions.append(self._motion)

    def _begin(self, status: ExecStatus) -> _Running | None:
        if self._subgoals is None or not self._subgoals.actions or self._subgoals.actions[0].action != status.action:
            return None
        if status.action not in self._domain.actions:
            names = ", ".join(self._domain.actions)
            raise UsageError(f"recorded action '{status.action}', expected one of {self._domain.robot}: {names}")
        instance, action = self._subgoals.actions[0], self._domain.actions[status.action]
        goal = arguments_of(action, instance)
        return _Running(status.action_index, instance, action, goal, self._is_in_context(action))

    def _adopt(self, run: _Running, new: InstantiatedAction, elapsed_s: float) -> None:
        """Start the episode anew if the goal of the running action changed; its step may have another number now.

        What has failed by then has failed on its way to the former goal.
        """
        same = (new.action, new.asserted) == (run.instance.action, run.instance.asserted)
        if not same or np.allclose(arguments_of(run.action, new), run.goal, atol=1e-6):
            return
        if run.failure:
            self._add(run, elapsed_s, run.failure, done=False)
        run.instance, run.goal, run.ticks, run.motions = new, arguments_of(run.action, new), [], []
        run.in_context, run.start, run.failure = self._is_in_context(run.action), None, ""

    def _is_in_context(self, action: Action) -> bool:
        """Whether the newest decision knew objects near which the action may fail."""
        decided, known = self._subgoals, self._contexts
        if decided is None or known is None or known.tick != decided.tick:
            return False
        return any(each.action == action.name and each.values for each in known.contexts)

    def _arguments(self, run: _Running, status: ExecStatus) -> Array:
        """The controller's arguments with the believed state in place of the start, as instantiation computes it."""
        names = (name.split(" ")[0] for name in self._domain.belief_names)
        belief = dict(zip(names, status.belief, strict=False))  # the last ones may be left out
        values = np.array([parameter.value for parameter in run.instance.parameters])
        other_names = self._sampler.start_names(run.action, values)
        for k, parameter in enumerate(run.action.parameters):
            if parameter.argument == 0:
                believed = belief.get(other_names.get(parameter.name, parameter.name))
                values[k] = values[k] if believed is None else believed  # a cup's spot is no state of the robot
        if run.action.arguments is unchanged:
            return values
        # mapped ones are those of the start, then those of the goal
        arguments = run.action.arguments(values[None, :])[0]
        return np.concatenate([arguments[: len(arguments) // 2], run.goal[len(arguments) // 2 :]])

    def _observe(self, message: Message) -> None:
        """Judge the running action by the ground truth."""
        run = self._running
        start = None if run is None else self._sampler.observed_start(message)
        if run is None or start is None:
            return
        run.start = run.start or start
        run.failure = run.failure or self._sampler.failure(run.action, run.start, message)

    def _finish(self, finished: ActionFinished) -> None:
        run, self._running = self._running, None
        if run is None or finished.outcome == "aborted":
            return
        done = finished.outcome == "done"
        failure = "" if done else reason_text(finished.reason, finished.detail)
        observed = bool(run.action.success_model or run.action.context) and run.start is not None
        self._add(run, finished.actual_s, run.failure or failure if observed else failure or UNOBSERVED, done)

    def _add(self, run: _Running, elapsed_s: float, failure: str, done: bool) -> None:
        """Add the episode of a run, `elapsed_s` after its action's start; none if it was too short."""
        if len(run.ticks) < MIN_TICKS:
            return
        ticks, duration_s, work_j = np.stack(run.ticks), elapsed_s - run.begun_s, self._work(run.motions)
        number, start, place = len(self.episodes), ticks[0], run.in_context
        episode = Episode(number, start, ticks, duration_s, not failure, failure, done, work_j, in_context=place)
        self.episodes.append((data_set_of(run.action), episode))

    def _work(self, motions: list[Message | None]) -> Array | None:
        """Joules of the drives from each tick to the next; None if a state of motion is missing."""
        if None in motions:
            return None
        work = self._sampler.work_j
        work_j = np.array([*(work(a, b) for a, b in itertools.pairwise(motions) if a and b), 0.0])
        return work_j if np.isfinite(work_j).all() else None


def data_set_of(action: Action) -> str:
    """Name of the data set of the action's episodes: actions that share a duration model share it."""
    return action.duration_model.split("/", maxsplit=1)[0]


def arguments_of(action: Action, instance: InstantiatedAction) -> Array:
    """Arguments of the controller for an action of a message, shape (k,)."""
    values = np.array([[parameter.value for parameter in instance.parameters]])
    arguments: Array = action.arguments(values)[0]
    return arguments
