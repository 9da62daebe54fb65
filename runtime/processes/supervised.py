"""One supervised process: specification, child, and what follows from its reports. The caller passes the time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from tailor.runtime.processes.child import Child
from tailor.runtime.processes.notify_socket import Report
from tailor.runtime.processes.restart import Restart
from tailor.schemas.messages import ProcessState

STARTUP_NS = 30_000_000_000  # from the start to the report that it is ready
STOPPING_NS = 3_000_000_000  # from the report that it is stopping to its end, at least


class State(StrEnum):
    """State of a supervised process."""

    STARTING = "starting"  # not ready yet
    RUNNING = "running"
    WAITING = "waiting"  # for its next start
    ENDED = "ended"  # and not to be started again


def _no_arguments(start: int) -> Sequence[str]:
    return ()


@dataclass(frozen=True, slots=True)
class ProcessSpec:
    """One process to supervise; it reports to the socket of NOTIFY_SOCKET, see notify.py.

    `silence_ns`: kill the process after this long without a report of its loop, or if it is not ready in time; None: no
    limit. This is the only way to detect a hung loop whose bus threads still run.
    `arguments`: further arguments of the n-th start, from 1 on, such as a leave to arm that a restart must not have.
    `must_begin`: it is not started again if its first start ends before it is ready: the caller gives up then.
    `restart_note`: what people have to know of each restart, to be read after "starting again in 0.2 s".
    """

    name: str
    argv: Sequence[str]
    restarts: bool = True
    must_begin: bool = False
    silence_ns: int | None = None
    arguments: Callable[[int], Sequence[str]] = _no_arguments
    restart_note: str = ""

    def command_line(self, start: int) -> list[str]:
        """Program and arguments of the n-th start."""
        return [*self.argv, *self.arguments(start)]


@dataclass(slots=True)
class Supervised:
    """A process between two polls."""

    spec: ProcessSpec
    child: Child
    started_ns: int
    starts: int = 1
    heard_ns: int | None = None  # of the last report since it is ready
    stopping: bool = False
    status: str = ""
    killed: bool = False
    restart: Restart = field(default_factory=Restart)
    start_at_ns: int | None = None  # end of the back-off
    over: bool = False  # ended, not to be restarted

    @property
    def state(self) -> State:
        """Starting until the child reports that it is ready."""
        if self.over:
            return State.ENDED
        if self.start_at_ns is not None:
            return State.WAITING
        return State.STARTING if self.heard_ns is None else State.RUNNING

    @property
    def has_begun(self) -> bool:
        """Whether it has been ready, or was started again since."""
        return self.starts > 1 or self.heard_ns is not None

    @property
    def missing(self) -> str:
        """What a silent child owes, for people: one that is not ready may well be alive, e.g. wait for its hardware."""
        ready = f"was not ready within {STARTUP_NS / 1e9:g} s"
        return ready if self.heard_ns is None else "gave no sign of life"

    def begin(self, child: Child, now_ns: int) -> None:
        """The next start."""
        self.child, self.started_ns, self.starts = child, now_ns, self.starts + 1
        self.heard_ns = self.start_at_ns = None
        self.stopping, self.killed, self.status = False, False, ""
        self.restart.started(now_ns)

    def hear(self, report: Report, now_ns: int) -> None:
        """Take a report into account; a loop that turns before it is ready does not count."""
        if report.ready or (self.heard_ns is not None and (report.alive or report.stopping)):
            self.heard_ns = now_ns
        self.stopping = self.stopping or report.stopping
        if report.status is not None:
            self.status = report.status

    def forgive(self, pause_ns: int, now_ns: int) -> None:
        """Do not count a pause of the supervisor as silence."""
        self.started_ns += pause_ns
        if self.heard_ns is not None:
            self.heard_ns = min(now_ns, self.heard_ns + pause_ns)

    def silent_ns(self, now_ns: int) -> int:
        """Time since the last report, or since the start; 0 unless it runs."""
        if self.state in (State.WAITING, State.ENDED):
            return 0
        return now_ns - (self.started_ns if self.heard_ns is None else self.heard_ns)

    def is_silent(self, now_ns: int) -> bool:
        """Whether it has exceeded its limit."""
        limit_ns = self.spec.silence_ns
        if limit_ns is None:
            return False
        if self.heard_ns is None:
            limit_ns = STARTUP_NS
        elif self.stopping:
            limit_ns = max(limit_ns, STOPPING_NS)
        return self.silent_ns(now_ns) > limit_ns

    def message(self, now_ns: int) -> ProcessState:
        """State for the bus, without sender id."""
        silent_s = self.silent_ns(now_ns) / 1e9
        return ProcessState(self.spec.name, self.child.pid, self.state.value, self.starts, silent_s, self.status, "")
