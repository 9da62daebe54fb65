"""Script that runs a program and kills all that it started, once it has ended or the script's standard input has.

Usage: `python subreaper.py BYTES PROGRAM ARGUMENTS…`. BYTES limits the address space of each process. Standard input is
a pipe from the owner; the kernel closes it at the owner's death, also after kill -9. The script exits as the program
did, by the same signal too.

As "child subreaper" (prctl(2), Linux 3.4) it becomes the parent of every orphan below it, so that no process gets away:
neither by a group or session of its own, nor by a second fork. It is a program of its own, because only exec is safe
between fork and exec in a process with threads.
"""

import ctypes
import os
import resource
import select
import sys
import time  # and no contextlib, which takes a tenth of this script's time to load

PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36  # <sys/prctl.h>
SIGHUP, SIGINT, SIGKILL, SIGPIPE, SIGTERM, SIGCONT, SIGXFSZ = 1, 2, 9, 13, 15, 18, 25  # signal takes long to load
SIG_DFL, SIG_IGN = None, ctypes.c_void_p(1)
END_S = 4.0  # a process that the kernel has not ended by then is left to end when it can
PAUSE_S = 0.002

_LIBC = ctypes.CDLL(None)


def main() -> None:
    """Run the program, await its end or that of the input, kill what is left, and exit as the program did."""
    _LIBC.prctl(PR_SET_CHILD_SUBREAPER, 1)
    _LIBC.prctl(PR_SET_PDEATHSIG, SIGCONT)  # one that somebody has stopped must read the end of its input
    for number in (SIGHUP, SIGINT, SIGTERM):  # systemd sends them to all processes of a service at once
        _LIBC.signal(number, SIG_IGN)
    program = os.fork()
    if program == 0:
        execute(int(sys.argv[1]), sys.argv[2:])
    ended = os.pidfd_open(program)
    select.select([ended, 0], [], [])
    exit_as(kill_all(program))


def execute(most_bytes: int, program: list[str]) -> None:
    """Become the program, in a group of its own: `kill 0` of a shell's script must not reach this process's parent."""
    os.setpgid(0, 0)
    _LIBC.prctl(PR_SET_PDEATHSIG, SIGKILL)
    for number in (SIGHUP, SIGINT, SIGTERM, SIGPIPE, SIGXFSZ):  # Python ignores the last two
        _LIBC.signal(number, SIG_DFL)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    try:  # noqa: SIM105
        resource.setrlimit(resource.RLIMIT_AS, (most_bytes, most_bytes))
    except ValueError:
        pass  # the limit that holds already is lower
    try:
        os.execvp(program[0], program)
    except OSError as error:
        os.write(2, f"{program[0]}: {error.strerror}\n".encode(errors="replace"))
        os._exit(127)


def kill_all(program: int) -> int:
    """Kill all children and the orphans that become children thereby; returns the program's wait status."""
    status, deadline_s = SIGKILL, time.monotonic() + END_S
    while time.monotonic() < deadline_s:
        try:
            ended, its_status = os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            break  # none is left
        if ended == program:
            status = its_status
        if ended == 0:
            for child in children():
                kill(child)
            time.sleep(PAUSE_S)
    return status


def kill(child: int) -> None:
    """Kill a child, which keeps its process id until it is waited for."""
    try:  # noqa: SIM105
        os.kill(child, SIGKILL)
    except PermissionError:
        pass  # it became another user


def children() -> list[int]:
    """Process ids of this process's children."""
    own = str(os.getpid())
    return [int(name) for name in os.listdir("/proc") if name.isdigit() and parent_of(name) == own]


def parent_of(name: str) -> str:
    """Process id of a process's parent; empty if it has just ended."""
    try:
        with open(f"/proc/{name}/stat", errors="replace") as stat:
            return stat.read().rpartition(")")[2].split()[1]
    except (OSError, IndexError):
        return ""


def exit_as(status: int) -> None:
    """End with a wait status: by the same signal, without another core dump, or with the same code."""
    if os.WIFSIGNALED(status):
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        _LIBC.signal(os.WTERMSIG(status), SIG_DFL)
        os.kill(os.getpid(), os.WTERMSIG(status))
    os._exit(os.waitstatus_to_exitcode(status))


if __name__ == "__main__":
    main()
