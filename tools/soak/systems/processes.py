"""What /proc shows of the processes of a launched system."""

from __future__ import annotations

import os
from pathlib import Path

_MODULE = b"tailor.tools.main"


def children(pid: int) -> dict[str, list[int]]:
    """Process ids of the running children of a launcher, by the tailor command that each runs, e.g. "sim"."""
    found: dict[str, list[int]] = {}
    try:
        pids = [int(word) for word in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except OSError:
        return found
    for child in pids:
        name = _command(child)
        if name and is_alive(child):
            found.setdefault(name, []).append(child)
    return found


def is_alive(pid: int) -> bool:
    """Whether a process runs; a zombie does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def own_mb(pid: int) -> float | None:
    """Resident memory without pages of files, whose code and data the kernel may drop; None if the process has ended.

    A leak grows it. Pages of a library's code come with every rare path that is taken for the first time.
    """
    try:
        sizes = dict(line.split(":", 1) for line in Path(f"/proc/{pid}/status").read_text().splitlines())
        return sum(int(sizes[name].split()[0]) for name in ("RssAnon", "RssShmem")) * 1024 / 1e6
    except (OSError, KeyError):
        return None


def naming(text: str) -> list[int]:
    """Processes whose command line contains `text`, except this one."""
    pids = [int(entry.name) for entry in Path("/proc").iterdir() if entry.name.isdigit()]
    return [pid for pid in pids if pid != os.getpid() and is_alive(pid) and text.encode() in _command_line(pid)]


def _command(pid: int) -> str:
    words = _command_line(pid).split(b"\0")
    at = words.index(_MODULE) + 1 if _MODULE in words else len(words)
    return words[at].decode(errors="replace") if at < len(words) else ""


def _command_line(pid: int) -> bytes:
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return b""
