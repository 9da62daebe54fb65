"""Starts child processes that cannot outlive their parent, and stops them in order with time limits."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO

STOP_S = 3.0  # for closing files and bringing the robot to rest; then SIGKILL
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}  # idle BLAS threads spin beside the loop
_PARENT_DEATH_SIGNAL = str(Path(__file__).with_name("parent_death_signal.py"))


def bound_to_parent(argv: Sequence[str]) -> list[str]:
    """The command that runs `argv` and ends it when this process is gone."""
    return [sys.executable, "-I", "-S", _PARENT_DEATH_SIGNAL, str(os.getpid()), *argv]


class Child:
    """One running child process."""

    def __init__(self, name: str, argv: Sequence[str], output: IO[str] | int | None = None) -> None:
        """Start `argv` on a leash.

        Args:
          name: What people call it.
          argv: Program and arguments.
          output: Where its stdout and stderr go; None: where ours go.
        """
        self.name = name
        environment = {**os.environ, **ONE_THREAD}
        # A session of its own: Ctrl-C in the terminal reaches the launcher alone, which then stops in order.
        self._process = subprocess.Popen(
            bound_to_parent(argv),
            env=environment,
            stdout=output,
            stderr=output,
            stdin=subprocess.DEVNULL,
            start_new_session=True,
        )

    @property
    def pid(self) -> int:
        """Process id; of the leash first, of the program after its exec: the same number."""
        return self._process.pid

    def exit_code(self) -> int | None:
        """None while it runs; negative: the signal that ended it."""
        return self._process.poll()

    def wait(self, timeout_s: float) -> int | None:
        """The exit code, or None if it still runs after `timeout_s`."""
        try:
            return self._process.wait(timeout_s)
        except subprocess.TimeoutExpired:
            return None

    def stop(self, timeout_s: float = STOP_S) -> int:
        """SIGTERM, wait, then SIGKILL; the exit code."""
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGTERM)
            if self.wait(timeout_s) is None:
                self.kill()
        return self._process.wait()

    def kill(self) -> None:
        """SIGKILL, and wait until it is gone."""
        self._process.kill()
        self._process.wait()


def tailor(*arguments: str) -> list[str]:
    """The command line of one of our own commands, run by this interpreter."""
    return [sys.executable, "-P", "-m", "tailor.tools.main", *arguments]


@contextmanager
def stopped_in_order(children: list[Child]) -> Iterator[list[Child]]:
    """Whatever happens inside, stop the children at the end, the one that was added last first."""
    try:
        yield children
    finally:
        for child in reversed(children):
            child.stop()
