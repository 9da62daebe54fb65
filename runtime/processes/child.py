"""Child processes that cannot outlive their parent, stopped in order with time limits."""

from __future__ import annotations

import contextlib
import os
import secrets
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from tailor.runtime.processes.notify import SOCKET_VARIABLE
from tailor.runtime.processes.notify_socket import NotifySocket, Report
from tailor.runtime.processes.orphans import kill_if_orphaned

STOP_S = 3.0  # enough to close files and stop the robot; then SIGKILL
KILL_S = 5.0  # after SIGKILL; a process that hangs in the kernel is left to end when it can
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}  # idle BLAS threads would spin beside the loop
_PARENT_DEATH_SIGNAL = str(Path(__file__).with_name("parent_death_signal.py"))


def _bound_to_parent(argv: Sequence[str]) -> list[str]:
    """Command that runs `argv`, which receives SIGTERM when this process dies."""
    return [sys.executable, "-I", "-S", _PARENT_DEATH_SIGNAL, str(os.getpid()), *argv]


class Child:
    """One running child process."""

    def __init__(
        self, name: str, argv: Sequence[str], output: IO[str] | int | None = None, notify_folder: Path | None = None
    ) -> None:
        """Start `argv`; when this process dies, the child receives SIGTERM, and SIGKILL 3 s later.

        Args:
          name: Name of the process in messages.
          argv: Program and arguments.
          output: Destination of stdout and stderr; None: those of this process.
          notify_folder: Folder, of this user alone, for the socket that the child reports to; None: it cannot report.

        Raises:
          OSError: The system refuses, e.g. for want of memory or descriptors; nothing is left behind.
        """
        self.name = name
        environment = {**os.environ, **ONE_THREAD}
        environment.pop(SOCKET_VARIABLE, None)  # that of this process itself, e.g. a service of systemd
        self._socket: NotifySocket | None = None
        if notify_folder is not None:
            self._socket = NotifySocket(notify_folder / f"{name}-{secrets.token_hex(4)}")
            environment[SOCKET_VARIABLE] = str(self._socket.path)
        try:
            self._process = _started(argv, environment, output)
        except OSError:
            if self._socket is not None:
                self._socket.close()
            raise

    @property
    def pid(self) -> int:
        """Process id; exec of the program keeps it."""
        return self._process.pid

    def report(self) -> Report:
        """What the child reported since the last call."""
        return Report() if self._socket is None else self._socket.poll(self.pid)

    def exit_code(self) -> int | None:
        """Exit code; None while the process runs; negative: the number of the signal that ended it."""
        code = self._process.poll()
        if code is not None and self._socket is not None:
            self._socket.close()
        return code

    def wait(self, timeout_s: float) -> int | None:
        """Exit code, or None if the process still runs after `timeout_s`."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(timeout_s)
        return self.exit_code()

    def stop(self, timeout_s: float = STOP_S) -> int | None:
        """Send SIGTERM, wait, then SIGKILL; returns the exit code, or None as `kill` does."""
        if self.exit_code() is None:
            self._process.send_signal(signal.SIGTERM)
            if self.wait(timeout_s) is None:
                return self.kill()
        return self.exit_code()

    def kill(self, timeout_s: float = KILL_S) -> int | None:
        """Send SIGKILL and wait for the end; returns the exit code, or None if the kernel has not ended it in time."""
        self._process.kill()
        return self.wait(timeout_s)


def _started(
    argv: Sequence[str], environment: Mapping[str, str], output: IO[str] | int | None
) -> subprocess.Popen[bytes]:
    """The process, which is killed if this one dies."""
    # A session of its own: Ctrl-C reaches only the launcher, which then stops its children in order.
    process = subprocess.Popen(
        _bound_to_parent(argv),
        env=environment,
        stdout=output,
        stderr=output,
        stdin=subprocess.DEVNULL,
        start_new_session=True,
    )
    try:
        kill_if_orphaned(process.pid)
    except OSError:  # nobody could stop it after the death of this process
        process.kill()
        process.wait(KILL_S)
        raise
    return process


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
