"""Runs the executive's requests on an external planner: one child at a time, one answer per request."""

from __future__ import annotations

import contextlib
from concurrent.futures import Future, ThreadPoolExecutor

from tailor.runtime.processes.planner_process import PlannerProcess
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import PlanAnswer, PlanRequest

MAX_ANSWER_BYTES = 131_072  # read within a tick; a plan of a hundred steps, with links and orderings, has half


class ExternalPlanner:
    """At most one running planner; `command` and `limit_s` as in `PlannerProcess`.

    Children are started on a thread: on a busy machine a start can take long, and the guard stops a robot whose
    executive waits that long.
    """

    def __init__(self, command: str, limit_s: float) -> None:
        """Starts no child, only the thread, before the loop becomes real-time."""
        self._command, self._limit_s = command, limit_s
        self._starter = ThreadPoolExecutor(1, "planner-starter") if command else None
        if self._starter is not None:
            self._starter.submit(int).result()
        self._child: Future[PlannerProcess] | None = None
        self._request_id = 0

    def request(self, request: PlanRequest) -> None:
        """Starts a child for a request, replacing any other; a failed start is reported as an answer."""
        self._drop()
        self._request_id = request.id
        if self._starter is not None:
            arguments = (request.domain, request.problem, self._limit_s, MAX_ANSWER_BYTES)
            self._child = self._starter.submit(PlannerProcess, self._command, *arguments)

    def poll(self, request_id: int, stamp_ns: int) -> PlanAnswer | None:
        """The answer to a request, once; None while there is none. Kills a child that works on another request."""
        if request_id != self._request_id:
            self._drop()
            return None
        if self._child is None or not self._child.done():
            return None
        try:
            result = self._child.result().poll()
        except UsageError as error:
            answer = PlanAnswer(stamp_ns, request_id, "missing", "", str(error))
        else:
            if result is None:
                return None
            answer = _publishable(PlanAnswer(stamp_ns, request_id, result.outcome, result.output, result.reason))
        self._drop()
        return answer

    def close(self) -> None:
        """Kills the child, if any, and ends the thread without waiting for it; no request follows."""
        self._drop()
        if self._starter is not None:
            self._starter.shutdown(wait=False)  # a child that is being started is still killed

    def _drop(self) -> None:
        """Kills the child, if any."""
        if self._child is not None:
            self._child.add_done_callback(_kill)  # now, or as soon as it has started
        self._child, self._request_id = None, 0


def _kill(child: Future[PlannerProcess]) -> None:
    with contextlib.suppress(UsageError):  # it never started
        child.result().kill()


def _publishable(answer: PlanAnswer) -> PlanAnswer:
    """The answer for the bus: without output if the planner failed or printed too much."""
    if answer.outcome != "answered":
        return PlanAnswer(answer.stamp_ns, answer.id, answer.outcome, "", answer.reason)
    size = len(answer.output.encode())
    if size <= MAX_ANSWER_BYTES:
        return answer
    reason = f"the planner's output has {size} bytes as text, more than {MAX_ANSWER_BYTES}"
    return PlanAnswer(answer.stamp_ns, answer.id, "flood", "", reason)
