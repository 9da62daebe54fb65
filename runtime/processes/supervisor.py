"""Supervises children: restarts dead ones with back-off, kills silent ones, reports a crash loop and gives up.

Restarting is safe: a driver that stopped by itself stays disarmed until it is armed again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from tailor.runtime.processes.child import Child
from tailor.runtime.processes.restart import Restart

FINAL_CODES = (0, 2)  # done; bad input, which a restart does not correct
STARTUP_NS = 30_000_000_000  # from the start to the first sign of life
PAUSE_NS = 500_000_000  # between two polls: the supervisor itself was paused, so its children's silence proves nothing


@dataclass(frozen=True, slots=True)
class ProcessSpec:
    """One process to supervise.

    `silence_ns`: kill the process after this long without a sign of life (`Supervisor.report_alive`); None: no limit.
    This is the only way to detect a hung loop whose bus threads still run.
    `first_argv`: arguments of the first start alone, such as a leave to arm, which a restart must not have.
    """

    name: str
    argv: Sequence[str]
    restarts: bool = True
    silence_ns: int | None = None
    first_argv: Sequence[str] = ()


@dataclass(slots=True)
class _Supervised:
    spec: ProcessSpec
    child: Child
    started_ns: int
    alive_ns: int | None = None
    restart: Restart = field(default_factory=Restart)
    start_at_ns: int | None = None  # end of the back-off
    over: bool = False  # ended, not to be restarted


class Supervisor:
    """Supervises processes; call `poll` a few times a second from one thread. It never blocks."""

    def __init__(self, report: Callable[[str], None], launch: Callable[[str, Sequence[str]], Child] = Child) -> None:
        """`report` receives one line per event; `launch` starts a child from a name and a command line."""
        self._report = report
        self._launch = launch
        self._processes: dict[str, _Supervised] = {}
        self._polled_ns: int | None = None

    def start(self, spec: ProcessSpec, now_ns: int) -> None:
        """Start a process and supervise it."""
        process = _Supervised(spec, self._launch(spec.name, [*spec.argv, *spec.first_argv]), now_ns)
        process.restart.started(now_ns)
        self._processes[spec.name] = process

    def report_alive(self, name: str, now_ns: int) -> None:
        """Record a sign of life, e.g. a message with a new sequence number."""
        self._processes[name].alive_ns = now_ns

    def ended(self, name: str) -> int | None:
        """Exit code of a process that is not started again; None while it runs or waits for a restart."""
        process = self._processes[name]
        return process.child.exit_code() if process.over else None

    def pid(self, name: str) -> int:
        """Process id of the current (or last) child."""
        return self._processes[name].child.pid

    def poll(self, now_ns: int) -> None:
        """Detect dead and silent processes; start those whose back-off has ended."""
        self._discount_own_pause(now_ns)
        for process in self._processes.values():
            if process.over:
                continue
            if process.start_at_ns is not None:
                self._start_when_due(process, now_ns)
            elif (code := process.child.exit_code()) is not None:
                self._died(process, code, now_ns)
            else:
                self._kill_when_silent(process, now_ns)

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
                process.started_ns += pause_ns
                if process.alive_ns is not None:
                    process.alive_ns = min(now_ns, process.alive_ns + pause_ns)

    def _died(self, process: _Supervised, code: int, now_ns: int) -> None:
        name = process.spec.name
        if not process.spec.restarts or code in FINAL_CODES:
            process.over = True
            if code != 0:
                self._report(f"{name} ended with {code}; not started again")
        elif process.restart.exhausted(now_ns):
            process.over = True
            self._report(f"{name} ended with {code}; gave up: too many starts within a minute")
        else:
            delay_ns = process.restart.delay_ns(now_ns)
            process.start_at_ns = now_ns + delay_ns
            self._report(f"{name} ended with {code}; starting again in {delay_ns / 1e9:.1f} s")

    def _start_when_due(self, process: _Supervised, now_ns: int) -> None:
        if process.start_at_ns is not None and now_ns >= process.start_at_ns:
            process.child = self._launch(process.spec.name, process.spec.argv)
            process.restart.started(now_ns)
            process.started_ns, process.alive_ns, process.start_at_ns = now_ns, None, None

    def _kill_when_silent(self, process: _Supervised, now_ns: int) -> None:
        limit_ns = process.spec.silence_ns
        if limit_ns is None:
            return
        if process.alive_ns is None:
            silent = now_ns - process.started_ns > STARTUP_NS
        else:
            silent = now_ns - process.alive_ns > limit_ns
        if silent:
            self._report(f"{process.spec.name} gave no sign of life; killed")
            process.child.kill()
