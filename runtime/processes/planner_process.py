"""Runs an external planner such as `vhpop` as a child process: polled without blocking, killed with all it started.

Owns the child, its files and its limits of time, output and memory. Does not parse the plan.
"""

from __future__ import annotations

import atexit
import contextlib
import os
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from tailor.runtime.planners.named import named_planner
from tailor.runtime.processes.last_line import LastLine
from tailor.runtime.processes.session_end import end_session
from tailor.schemas.errors import UsageError

MAX_OUTPUT_BYTES = 1_000_000  # a printed plan of a thousand steps has a tenth of that
MAX_MEMORY_BYTES = 2 << 30  # address space; the robot's own processes run on the same machine
_CHUNK = 65536
_END_S = 5.0  # a subreaper has killed all processes by then, or gives up itself
_SUBREAPER = str(Path(__file__).with_name("subreaper.py"))
# vfork blocks all threads until the child has started (see the notes of subprocess)
vars(subprocess)["_USE_VFORK"] = False


Outcome = Literal["answered", "crashed", "timeout", "flood"]


@dataclass(frozen=True, slots=True)
class PlannerAnswer:
    """Outcome and output of a child: it exited, crashed by a signal, or was killed (timeout, flood)."""

    outcome: Outcome
    output: str
    reason: str


class PlannerProcess:
    """One run of an external planner on one problem."""

    def __init__(
        self,
        command: str,
        domain: str,
        problem: str,
        limit_s: float,
        max_bytes: int = MAX_OUTPUT_BYTES,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Starts the child as `command DOMAIN PROBLEM`, below a process that ends whatever it starts.

        Args:
          command: Program and arguments, quoted as in a shell but run without one: "vhpop -g -f MW-Loc"; or a name:
            "kairos", "kairos:5", "up:pyperplan".
          domain: PDDL text, passed in a file.
          problem: PDDL text, passed in a file.
          limit_s: Wall time in seconds after which it is killed; vhpop's own -T has a resolution of minutes.
          max_bytes: Size of the output after which it is killed; a poll reads about 64 kB, a full pipe.
          clock: Monotonic clock in seconds.

        Raises:
          UsageError: The command cannot be started.
        """
        self._clock = clock
        self._limit_s = limit_s
        self._max_bytes = max_bytes
        self._output = bytearray()
        self._answer: PlannerAnswer | None = None
        try:
            self._folder = tempfile.TemporaryDirectory(prefix="tailor-planner-", ignore_cleanup_errors=True)
        except OSError as error:
            raise _cannot_start(command, error) from None
        self._child = self._start(command, {"domain.pddl": domain, "problem.pddl": problem})
        assert self._child.stderr is not None
        self._errors = LastLine(self._child.stderr)
        self._deadline = clock() + limit_s

    def _start(self, command: str, files: Mapping[str, str]) -> subprocess.Popen[bytes]:
        paths = [Path(self._folder.name) / name for name in files]
        try:
            words = split_command(command)
            for path, text in zip(paths, files.values(), strict=True):
                path.write_text(text, encoding="utf-8")
            child = subprocess.Popen(
                [sys.executable, "-I", "-S", _SUBREAPER, str(MAX_MEMORY_BYTES), *words, *map(str, paths)],
                bufsize=0,
                stdin=subprocess.PIPE,  # kills the planner when it is closed, also by the death of this process
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                start_new_session=True,
            )
        except OSError as error:
            self._folder.cleanup()
            raise _cannot_start(command, error) from None
        except UsageError:
            self._folder.cleanup()
            raise
        assert child.stdout is not None
        os.set_blocking(child.stdout.fileno(), False)
        return child

    @property
    def pid(self) -> int:
        """Process id of the child, equal to its session id."""
        return self._child.pid

    def poll(self) -> PlannerAnswer | None:
        """Reads the output without blocking; returns the answer once the child has ended, None before."""
        if self._answer is not None:
            return self._answer
        ended = self._child.poll() is not None
        self._read()
        if len(self._output) > self._max_bytes:
            self._end("flood", f"the planner printed more than {self._max_bytes} bytes")
        elif ended:
            code = self._child.returncode
            self._end("crashed" if code < 0 else "answered", f"the planner ended with code {code}")
        elif self._clock() >= self._deadline:
            self._end("timeout", f"the planner was killed after {self._limit_s:g} s")
        return self._answer

    def kill(self) -> None:
        """Kills the child and all that it started; safe to call again."""
        if self._answer is None:
            self._end("timeout", "the planner was killed")

    def _read(self) -> None:
        self._errors.read()
        assert self._child.stdout is not None
        descriptor = self._child.stdout.fileno()
        while len(self._output) <= self._max_bytes:
            try:
                chunk = os.read(descriptor, _CHUNK)
            except BlockingIOError:
                return
            if not chunk:
                return
            self._output += chunk

    def _end(self, outcome: Outcome, reason: str) -> None:
        assert self._child.stdin is not None
        assert self._child.stdout is not None
        with contextlib.suppress(OSError):  # it has ended
            self._child.stdin.write(b"\n")  # heard although a fork of this process holds the pipe open
        self._child.stdin.close()
        self._child.send_signal(signal.SIGCONT)  # somebody may have stopped it
        self._child.stdout.close()
        self._errors.close()
        self._tidy_aside()
        text = self._output[: self._max_bytes].decode("utf-8-sig", errors="replace")
        last = self._errors.quoted()
        self._answer = PlannerAnswer(outcome, text, f"{reason} (stderr: {last})" if last else reason)

    def _tidy_aside(self) -> None:
        """Tidy up on a thread that outlives the tick, and is awaited at the end of this process."""
        try:
            threading.Thread(target=self._tidy, name="planner-end").start()
        except RuntimeError:  # the system has no thread left
            atexit.register(self._tidy)

    def _tidy(self) -> None:
        """Remove the files; those of the planner as well, which may be many, once nobody writes more beside them."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._child.wait(_END_S)
        if self._child.returncode is None or self._child.returncode < 0:  # stopped, or killed before its children
            end_session(self._child.pid)
        self._folder.cleanup()


def split_command(command: str) -> list[str]:
    """A planner's command or name as program and arguments; raises UsageError if there is no such program."""
    if "\0" in command:
        raise _cannot_start(command.replace("\0", "\\0"), "it contains a NUL")
    named = named_planner(command)
    if named is not None:
        return named
    try:
        words = shlex.split(command)
    except ValueError as error:
        raise _cannot_start(command, error) from None
    if not words:
        raise _cannot_start(command, "it is empty")
    if shutil.which(words[0]) is None:
        reason = f"'{words[0]}' is not executable" if os.path.isfile(words[0]) else f"there is no program '{words[0]}'"
        raise _cannot_start(command, reason)
    return words


def _cannot_start(command: str, reason: object) -> UsageError:
    return UsageError(f"planner command '{command}': cannot be started: {reason}")
