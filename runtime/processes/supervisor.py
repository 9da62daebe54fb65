"""Supervises children: restarts dead ones with back-off, kills silent ones, reports a crash loop and gives up.

Restarting is safe: a driver that stopped by itself stays disarmed until it is armed again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tailor.runtime.processes.child import Child
from tailor.runtime.processes.supervised import ProcessSpec, State, Supervised
from tailor.schemas.messages import ProcessState

BAD_INPUT = 2
FINAL_CODES = (0, BAD_INPUT)  # done; what a restart does not correct
PAUSE_NS = 500_000_000  # between two polls: the supervisor itself was paused, so its children's silence proves nothing


class Supervisor:
    """Supervises processes; call `poll` a few times a second from one thread. It never blocks."""

    def __init__(self, report: Callable[[str], None], launch: Callable[[str, Sequence[str]], Child] = Child) -> None:
        """`report` receives one line per event; `launch` starts a child from a name and a command line."""
        self._report = report
        self._launch = launch
        self._processes: dict[str, Supervised] = {}
        self._polled_ns: int | None = None

    def start(self, spec: ProcessSpec, now_ns: int) -> None:
        """Start a process and supervise it."""
        process = Supervised(spec, self._launch(spec.name, spec.command_line(1)), now_ns)
        process.restart.started(now_ns)
        self._processes[spec.name] = process

    def state(self, name: str) -> State:
        """State of a process."""
        return self._processes[name].state

    def starts(self, name: str) -> int:
        """How often a process was started."""
        return self._processes[name].starts

    def refused(self, name: str) -> bool:
        """Whether a process has ended for bad input, before it was ready for the first time."""
        process = self._processes[name]
        return process.state is State.ENDED and not process.has_begun and process.child.exit_code() == BAD_INPUT

    def status(self, name: str) -> str:
        """What a process reported last of its own state, for people."""
        return self._processes[name].status

    def states(self, now_ns: int) -> tuple[ProcessState, ...]:
        """States of all processes for the bus, in the order of their first starts; without their sender ids."""
        return tuple(process.message(now_ns) for process in self._processes.values())

    def poll(self, now_ns: int) -> None:
        """Read reports; detect dead and silent processes; start those whose back-off has ended."""
        self._discount_own_pause(now_ns)
        for process in self._processes.values():
            if process.over:
                continue
            if process.start_at_ns is not None:
                self._start_when_due(process, now_ns)
                continue
            process.hear(process.child.report(), now_ns)
            if (code := process.child.exit_code()) is not None:
                self._died(process, code, now_ns)
            elif process.is_silent(now_ns) and not process.killed:
                self._report(f"{process.spec.name} {process.missing}; killed")
                process.killed = True
                process.child.kill(0.0)  # one that hangs in the kernel, e.g. on a dead disk, ends later or never

    def stop(self) -> None:
        """Stop all processes in the reverse order of their starts."""
        for process in reversed(self._processes.values()):
            process.over = True
            process.child.stop()

    def _discount_own_pause(self, now_ns: int) -> None:
        """Do not count a pause of the supervisor (Ctrl-Z) as silence: the router in this process was paused, too."""
        pause_ns = 0 if self._polled_ns is None else now_ns - self._polled_ns
        self._polled_ns = now_ns
        if pause_ns > PAUSE_NS:
            for process in self._processes.values():
                process.forgive(pause_ns, now_ns)

    def _died(self, process: Supervised, code: int, now_ns: int) -> None:
        gives_up = process.spec.must_begin and not process.has_begun
        if not process.spec.restarts or code in FINAL_CODES or gives_up:
            process.over = True
            if code != 0 or process.spec.restarts:  # one that is to run on has been ended from outside, e.g. by `kill`
                self._report(f"{process.spec.name} ended with {code}; not started again")
        else:
            self._start_later(process, f"ended with {code}", now_ns)

    def _start_later(self, process: Supervised, why: str, now_ns: int) -> None:
        if process.restart.exhausted(now_ns):
            process.over = True
            self._report(f"{process.spec.name} {why}; gave up: too many starts within a minute")
        else:
            delay_ns = process.restart.delay_ns(now_ns)
            process.start_at_ns = now_ns + delay_ns
            note = process.spec.restart_note
            self._report(f"{process.spec.name} {why}; starting again in {delay_ns / 1e9:.1f} s{note}")

    def _start_when_due(self, process: Supervised, now_ns: int) -> None:
        if process.start_at_ns is None or now_ns < process.start_at_ns:
            return
        argv = process.spec.command_line(process.starts + 1)
        try:
            child = self._launch(process.spec.name, argv)
        except OSError as error:  # no memory, processes, descriptors or place on a disk: the others go on
            process.restart.started(now_ns)
            self._start_later(process, f"cannot be started: {error.strerror}", now_ns)
        else:
            process.begin(child, now_ns)
