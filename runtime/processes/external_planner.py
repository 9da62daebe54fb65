"""Carries the executive's requests to an external planner: one child at a time, an answer whatever becomes of it."""

from __future__ import annotations

import contextlib
from concurrent.futures import Future, ThreadPoolExecutor

from tailor.runtime.processes.planner_process import PlannerProcess
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import PlanAnswer, PlanRequest

MAX_ANSWER_BYTES = 131_072  # read within a tick; a plan of a hundred steps with all its links and orderings has half


class ExternalPlanner:
    """At most one running planner; `command` and `limit_s` as PlannerProcess takes them.

    Children are started on a thread: on a busy machine it can take long until a child has begun, and a robot whose
    executive waits for that is stopped by its guard.
    """

    def __init__(self, command: str, limit_s: float) -> None:
        """Starts no child; the thread is there before the loop becomes real-time."""
        self._command, self._limit_s = command, limit_s
        self._starter = ThreadPoolExecutor(1, "planner-starter") if command else None
        if self._starter is not None:
            self._starter.submit(int).result()
        self._child: Future[PlannerProcess] | None = None
        self._asked = 0

    def request(self, request: PlanRequest) -> None:
        """Start a child on a request, in the place of any other; that it cannot be started is an answer, too."""
        self.close()
        self._asked = request.id
        if self._starter is not None:
            arguments = (request.domain, request.problem, self._limit_s, MAX_ANSWER_BYTES)
            self._child = self._starter.submit(PlannerProcess, self._command, *arguments)

    def poll(self, awaited: int, stamp_ns: int) -> PlanAnswer | None:
        """The answer to the request `awaited`, once; None while there is none. Kills a child that works on another."""
        if awaited != self._asked:
            self.close()
            return None
        if self._child is None or not self._child.done():
            return None
        try:
            said = self._child.result().poll()
        except UsageError as error:
            answer = PlanAnswer(stamp_ns, awaited, "missing", "", str(error))
        else:
            if said is None:
                return None
            answer = _believable(PlanAnswer(stamp_ns, awaited, said.outcome, said.output, said.reason))
        self.close()
        return answer

    def close(self) -> None:
        """Leave no child behind."""
        if self._child is not None:
            self._child.add_done_callback(_kill)  # at once, or as soon as it has been started
        self._child, self._asked = None, 0


def _kill(child: Future[PlannerProcess]) -> None:
    with contextlib.suppress(UsageError):  # it was never started
        child.result().kill()


def _believable(answer: PlanAnswer) -> PlanAnswer:
    """The answer as it goes on the bus: without the output of a planner that did not end well, or says too much."""
    if answer.outcome != "answered":
        return PlanAnswer(answer.stamp_ns, answer.id, answer.outcome, "", answer.reason)
    size = len(answer.output.encode())
    if size <= MAX_ANSWER_BYTES:
        return answer
    reason = f"the planner's output has {size} bytes as text, more than {MAX_ANSWER_BYTES}"
    return PlanAnswer(answer.stamp_ns, answer.id, "flood", "", reason)
