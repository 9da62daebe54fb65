"""An episode out of what was heard of a run on the bus, measured as in lock-step: from first action to last."""

from __future__ import annotations

from collections.abc import Iterable

from tailor.schemas.messages import ActionFinished, ExecStatus, Message, Subgoals
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.tools.lockstep.run import Run


class NullScreen:
    """A screen that nobody looks at; see tailor.tools.cli.live_status.Screen."""

    def tell(self, line: str) -> None:
        """Drop a line."""

    def show(self, message: Message) -> None:
        """Drop a message."""


def episode_of(messages: Iterable[Message], result: str) -> Run:
    """Sum a run's messages up, in the order in which they were recorded.

    Args:
      messages: Of one executive and one simulator. Stamps are one clock's.
      result: "achieved", or why not.
    """
    episode = Run(result)
    started_ns: int | None = None
    for message in messages:
        episode.messages.append(message)
        if isinstance(message, ExecStatus):
            episode.status.append(message)
            if started_ns is None and message.action:
                started_ns = message.stamp_ns
                episode.started_s = 0.0
        elif isinstance(message, ActionFinished):
            episode.finished.append(message)
            if started_ns is not None:
                episode.ended_s = (message.stamp_ns - started_ns) / 1e9
        elif isinstance(message, Subgoals):
            episode.subgoals.append(message)
        elif isinstance(message, SoccerGroundTruth):
            episode.truth.append(message)
    return episode
