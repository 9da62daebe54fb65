"""Ends all processes of a session: a program may start others in process groups of their own, as `timeout` does."""

from __future__ import annotations

import contextlib
import os
import signal
import time
from pathlib import Path

ROUNDS, PAUSE_S = 50, 0.01  # a process that is being killed may just have started another


def end_session(leader: int) -> None:
    """Kill what is left of the session of a process that called setsid; takes milliseconds for hundreds of processes.

    A process that has begun a session of its own is not found.
    """
    for _ in range(ROUNDS):
        left = members(leader)
        if not left:
            return
        for pid in left:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.kill(pid, signal.SIGKILL)
        time.sleep(PAUSE_S)


def members(leader: int) -> list[int]:
    """Processes of a session that still run, zombies left out."""
    return [int(path.name) for path in Path("/proc").iterdir() if path.name.isdigit() and _runs_in(path, leader)]


def _runs_in(process: Path, leader: int) -> bool:
    try:
        state, _, _, session = (process / "stat").read_text(errors="replace").rpartition(")")[2].split()[:4]
    except (OSError, ValueError):  # it has just ended
        return False
    return int(session) == leader and state not in "ZX"
