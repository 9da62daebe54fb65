"""Follows a goal on the bus from before it is sent to its end, and prints what the executive does."""

from __future__ import annotations

import time
from collections.abc import Callable

from tailor.runtime.bus.inbox import Inbox
from tailor.runtime.stopping import Stop
from tailor.schemas.reason_text import without_numbers
from tailor.tools.cli.plain_text import plain
from tailor.tools.operator.goal_wait import SILENT_S, GoalWait

POLL_S = 0.05
FIRST_S = 1.0  # until the status of an executive is heard: it tells what is of a tick before the goal
PURSUED = "the goal is still pursued: `tailor goal --cancel` drops it"
SILENT = f"the executive has been silent for {SILENT_S:g} s: `tailor status` tells; one that starts again has no goal"


class GoalFollower:
    """Follows one goal by the statuses in an inbox."""

    def __init__(self, inbox: Inbox, goal: str) -> None:
        """`inbox`: of the topic "status"; `goal`: as it is sent, empty for that of the scenario."""
        self.wait = GoalWait(goal)
        self._inbox = inbox

    def look(self) -> None:
        """Hear an executive before the goal is sent, if there is one."""
        end_s = time.monotonic() + FIRST_S
        while not self._hear() and time.monotonic() < end_s:
            time.sleep(POLL_S)

    def follow(self, timeout_s: float, show: Callable[[str], None], stop: Stop) -> str:
        """Print a line whenever what the executive does has changed, until the goal has ended.

        Args:
          timeout_s: Give up then; the goal is still pursued.
          show: Prints a line.
          stop: Ends the wait; the goal is still pursued.

        Returns:
          Why it is not known what became of the goal; "" if it is, or a stop was requested.
        """
        self._hear()  # what came before the answer may be of a tick before the goal
        begun_s, last = time.monotonic(), ""
        self.wait.accept(begun_s)
        while self.wait.result is None and not stop.requested:
            self._hear()
            now_s, line = time.monotonic(), self.wait.line
            if without_numbers(line) != last:
                last = without_numbers(line)
                show(plain(line))
            if self.wait.lost(now_s):
                return SILENT
            if now_s - begun_s > timeout_s and self.wait.result is None:
                return f"no end within {timeout_s:g} s; {PURSUED}"
            time.sleep(POLL_S)
        return ""

    def _hear(self) -> bool:
        samples = self._inbox.drain(time.monotonic_ns())
        for sample in samples:
            self.wait.hear(sample, time.monotonic())
        return bool(samples)
