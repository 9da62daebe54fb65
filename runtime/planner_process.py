"""Runs an external planner (a real `vhpop`) as a child process: polled, never waited for, killed with its whole group.

Owns the child, its files and its limits of time and output; reading the plan is the caller's business.
"""

from __future__ import annotations

import contextlib
import os
import shlex
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from schemas.errors import UsageError

MAX_OUTPUT_BYTES = 1_000_000  # a printed plan of a thousand steps has a tenth of that
_CHUNK = 65536


@dataclass(frozen=True, slots=True)
class PlannerAnswer:
    """How the child ended. The output is whatever it printed; only `answered` promises that it ended by itself."""

    outcome: Literal["answered", "timeout", "flood"]
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
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Starts the child as `command DOMAIN PROBLEM` in a process group of its own.

        Args:
          command: As in a shell, without one: "vhpop -g -f MW-Loc".
          domain: PDDL text, handed over in a file.
          problem: PDDL text, handed over in a file.
          limit_s: Wall time after which the group is killed; vhpop's own -T only knows whole minutes.
          clock: Seconds that only grow.

        Raises:
          UsageError: The command cannot be started.
        """
        self._clock = clock
        self._limit_s = limit_s
        self._output = bytearray()
        self._answer: PlannerAnswer | None = None
        self._folder = tempfile.TemporaryDirectory(prefix="tailor-planner-")
        paths = [Path(self._folder.name) / name for name in ("domain.pddl", "problem.pddl")]
        for path, text in zip(paths, (domain, problem), strict=True):
            path.write_text(text, encoding="utf-8")
        self._child = self._start(command, paths)
        self._deadline = clock() + limit_s

    def _start(self, command: str, paths: list[Path]) -> subprocess.Popen[bytes]:
        try:
            words = shlex.split(command)
            if not words:
                raise ValueError("it is empty")
            child = subprocess.Popen(
                [*words, *map(str, paths)],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                start_new_session=True,
            )
        except (OSError, ValueError) as error:
            self._folder.cleanup()
            raise UsageError(f"planner command '{command}': cannot be started: {error}") from None
        assert child.stdout is not None
        os.set_blocking(child.stdout.fileno(), False)
        return child

    @property
    def pid(self) -> int:
        """The child's process id, which is its group's as well."""
        return self._child.pid

    def poll(self) -> PlannerAnswer | None:
        """Reads what has been printed; the answer once there is one, None before. Never blocks."""
        if self._answer is not None:
            return self._answer
        ended = self._child.poll() is not None
        self._read()
        if len(self._output) > MAX_OUTPUT_BYTES:
            self._end("flood", f"the planner printed more than {MAX_OUTPUT_BYTES} bytes")
        elif ended:
            self._end("answered", f"the planner ended with code {self._child.returncode}")
        elif self._clock() >= self._deadline:
            self._end("timeout", f"the planner was killed after {self._limit_s:g} s")
        return self._answer

    def kill(self) -> None:
        """Kills the child's whole group; safe to call again."""
        if self._answer is None:
            self._end("timeout", "the planner was killed")

    def _read(self) -> None:
        assert self._child.stdout is not None
        descriptor = self._child.stdout.fileno()
        while len(self._output) <= MAX_OUTPUT_BYTES:
            try:
                chunk = os.read(descriptor, _CHUNK)
            except BlockingIOError:
                return
            if not chunk:
                return
            self._output += chunk

    def _end(self, outcome: Literal["answered", "timeout", "flood"], reason: str) -> None:
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(self._child.pid, signal.SIGKILL)  # a child that ended may have left children of its own
        self._child.wait()
        assert self._child.stdout is not None
        self._child.stdout.close()
        self._folder.cleanup()
        text = self._output[:MAX_OUTPUT_BYTES].decode("utf-8", errors="replace")
        self._answer = PlannerAnswer(outcome, text, reason)
