"""Watches children: restarts the dead with back-off, kills the silent, gives up on a crash loop and says why.

A restarted process is disarmed by construction (a driver obeys nobody after its own stop), so restarting is safe.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from tailor.runtime.processes.child import Child
from tailor.runtime.processes.restart import Restart

FINAL_CODES = (0, 2)  # done; bad input, which another start would not mend
STARTUP_NS = 30_000_000_000  # from start to the first sign of life
PAUSE_NS = 500_000_000  # between two looks: then it was us who stood still, and no child can be blamed for silence


@dataclass(frozen=True, slots=True)
class ProcessSpec:
    """One process to look after.

    `silence_ns`: kill it after this long without a sign of life (`Supervisor.heard`); None: it gives none. A hung loop
    whose bus threads live on is noticed by that alone.
    """

    name: str
    argv: Sequence[str]
    restarts: bool = True
    silence_ns: int | None = None


@dataclass(slots=True)
class _Watch:
    charge: ProcessSpec
    child: Child
    started_ns: int
    heard_ns: int | None = None
    restart: Restart = field(default_factory=Restart)
    start_at_ns: int | None = None  # waiting for its back-off to end
    over: bool = False  # ended for good


class Supervisor:
    """Call `look` a few times a second from one thread; it never blocks."""

    def __init__(self, tell: Callable[[str], None], start: Callable[[str, Sequence[str]], Child] = Child) -> None:
        """`tell` gets one line per event; `start` makes a child of a name and a command line."""
        self._tell = tell
        self._start = start
        self._watches: dict[str, _Watch] = {}
        self._looked_ns: int | None = None

    def start(self, charge: ProcessSpec, now_ns: int) -> None:
        """Start a process and look after it."""
        watch = _Watch(charge, self._start(charge.name, charge.argv), now_ns)
        watch.restart.started(now_ns)
        self._watches[charge.name] = watch

    def report_alive(self, name: str, now_ns: int) -> None:
        """A sign of life, e.g. a message with a new sequence number."""
        self._watches[name].heard_ns = now_ns

    def ended(self, name: str) -> int | None:
        """The exit code of a process that will not be started again; None while it lives or may live again."""
        watch = self._watches[name]
        return watch.child.exit_code() if watch.over else None

    def pid(self, name: str) -> int:
        """Process id of the present (or last) incarnation."""
        return self._watches[name].child.pid

    def poll(self, now_ns: int) -> None:
        """Notice deaths and silences; start what is due."""
        self._forgive_own_pause(now_ns)
        for watch in self._watches.values():
            if watch.over:
                continue
            if watch.start_at_ns is not None:
                self._start_when_due(watch, now_ns)
            elif (code := watch.child.exit_code()) is not None:
                self._died(watch, code, now_ns)
            else:
                self._kill_when_silent(watch, now_ns)

    def stop(self) -> None:
        """Stop everything, what was started last first."""
        for watch in reversed(self._watches.values()):
            watch.over = True
            watch.child.stop()

    def _forgive_own_pause(self, now_ns: int) -> None:
        """Time in which we did not run (Ctrl-Z) is no silence of theirs: our router stood still, too."""
        pause_ns = 0 if self._looked_ns is None else now_ns - self._looked_ns
        self._looked_ns = now_ns
        if pause_ns > PAUSE_NS:
            for watch in self._watches.values():
                watch.started_ns += pause_ns
                if watch.heard_ns is not None:
                    watch.heard_ns = min(now_ns, watch.heard_ns + pause_ns)

    def _died(self, watch: _Watch, code: int, now_ns: int) -> None:
        name = watch.charge.name
        if not watch.charge.restarts or code in FINAL_CODES:
            watch.over = True
            if code != 0:
                self._tell(f"{name} ended with {code}; not started again")
        elif watch.restart.exhausted(now_ns):
            watch.over = True
            self._tell(f"{name} ended with {code}; gave up: too many starts within a minute")
        else:
            delay_ns = watch.restart.delay_ns(now_ns)
            watch.start_at_ns = now_ns + delay_ns
            self._tell(f"{name} ended with {code}; starting again in {delay_ns / 1e9:.1f} s")

    def _start_when_due(self, watch: _Watch, now_ns: int) -> None:
        if watch.start_at_ns is not None and now_ns >= watch.start_at_ns:
            watch.child = self._start(watch.charge.name, watch.charge.argv)
            watch.restart.started(now_ns)
            watch.started_ns, watch.heard_ns, watch.start_at_ns = now_ns, None, None

    def _kill_when_silent(self, watch: _Watch, now_ns: int) -> None:
        limit_ns = watch.charge.silence_ns
        if limit_ns is None:
            return
        if watch.heard_ns is None:
            silent = now_ns - watch.started_ns > STARTUP_NS
        else:
            silent = now_ns - watch.heard_ns > limit_ns
        if silent:
            self._tell(f"{watch.charge.name} gives no sign of life; killed")
            watch.child.kill()
