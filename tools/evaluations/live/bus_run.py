"""Reads a live run back from its messages, measured as in lock-step: from the first action to the last."""

from __future__ import annotations

from collections.abc import Iterable

from tailor.schemas.messages import ActionFinished, ExecStatus, Message, Subgoals
from tailor.schemas.topics import TOPICS
from tailor.tools.lockstep.run import Run

TRUTH_KEYS = tuple(topic.key.partition("/")[2] for topic in TOPICS.values() if topic.source == "simulator")


class NullScreen:
    """Discards all output; see tailor.tools.cli.live_status.Screen."""

    def report(self, line: str) -> None:
        """Discard a line."""

    def show(self, message: Message) -> None:
        """Discard a message."""


def run_of(messages: Iterable[tuple[str, Message]], result: str) -> Run:
    """Summarise a run's messages.

    Args:
      messages: Keys and messages of one executive and one simulator in the order of their recording. The stamps are
        of one clock.
      result: "achieved", or the reason of the failure.
    """
    run = Run(result)
    started_ns: int | None = None
    for key, message in messages:
        run.messages.append(message)
        if isinstance(message, ExecStatus):
            run.status.append(message)
            if started_ns is None and message.action:
                started_ns = message.stamp_ns
                run.started_s = 0.0
        elif isinstance(message, ActionFinished):
            run.finished.append(message)
            if started_ns is not None:
                run.ended_s = (message.stamp_ns - started_ns) / 1e9
        elif isinstance(message, Subgoals):
            run.subgoals.append(message)
        elif key.partition("/")[2] in TRUTH_KEYS:
            run.truth.append(message)
    return run
