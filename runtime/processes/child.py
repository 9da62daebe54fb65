"""Child processes that cannot outlive their parent, stopped in order with time limits."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO

STOP_S = 3.0  # enough to close files and stop the robot; then SIGKILL
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}  # idle BLAS threads would spin beside the loop
_PARENT_DEATH_SIGNAL = str(Path(__file__).with_name("parent_death_signal.py"))


def bound_to_parent(argv: Sequence[str]) -> list[str]:
    """Command that runs `argv` and terminates it when this process dies."""
    return [sys.executable, "-I", "-S", _PARENT_DEATH_SIGNAL, str(os.getpid()), *argv]


class Child:
    """One running child process."""

    def __init__(self, name: str, argv: Sequence[str], output: IO[str] | int | None = None) -> None:
        """Start `argv`; the kernel terminates it when this process dies.

        Args:
          name: Name of the process in messages.
          argv: Program and arguments.
          output: Destination of stdout and stderr; None: those of this process.
        """
        self.name = name
        environment = {**os.environ, **ONE_THREAD}
        # A session of its own: Ctrl-C reaches only the launcher, which then stops its children in order.
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
        """Process id; exec of the program keeps it."""
        return self._process.pid

    def exit_code(self) -> int | None:
        """Exit code; None while the process runs; negative: the number of the signal that ended it."""
        return self._process.poll()

    def wait(self, timeout_s: float) -> int | None:
        """Exit code, or None if the process still runs after `timeout_s`."""
        try:
            return self._process.wait(timeout_s)
        except subprocess.TimeoutExpired:
            return None

    def stop(self, timeout_s: float = STOP_S) -> int:
        """Send SIGTERM, wait, then SIGKILL; returns the exit code."""
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGTERM)
            if self.wait(timeout_s) is None:
                self.kill()
        return self._process.wait()

    def kill(self) -> None:
        """Send SIGKILL and wait for the end."""
        self._process.kill()
        self._process.wait()


def tailor(*arguments: str) -> list[str]:
    """Command line of a tailor command, run by this interpreter without the current folder on its path (-P)."""
    return [sys.executable, "-P", "-m", "tailor.tools.main", *arguments]


@contextmanager
def stopped_in_order(children: list[Child]) -> Iterator[list[Child]]:
    """Stop the children at the end of the block, also after an error; the last one added is stopped first."""
    try:
        yield children
    finally:
        for child in reversed(children):
            child.stop()
