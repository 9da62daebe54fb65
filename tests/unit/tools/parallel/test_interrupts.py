"""Ctrl-C reaches all processes of a terminal; only the command itself reacts, and ends its workers. So does SIGTERM."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import threading
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from tailor.runtime.processes.child import tailor
from tailor.tools.cli.termination import interrupted_by_sigterm
from tailor.tools.parallel.pool import completed, in_order
from tailor.tools.parallel.quiet_shutdown import quieten_shutdown
from tests.support.bus_system import ROOT
from tests.support.injection.signals import heeded_signals
from tests.support.patience import PATIENCE_S

WORKER = b"popen_loky"


def is_blocked(_: int) -> bool:
    return {signal.SIGINT, signal.SIGTERM} <= signal.pthread_sigmask(signal.SIG_BLOCK, ())


def workers_of(pid: int) -> list[int]:
    """Processes of a pool, from their first instruction on."""
    found = []
    with contextlib.suppress(OSError):  # a process that ends
        for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split():
            if WORKER in Path(f"/proc/{child}/cmdline").read_bytes():
                found.append(int(child))
    return found


def interrupted() -> int:
    signal.raise_signal(signal.SIGTERM)  # in this thread, before the next line
    return 0


def test_a_command_that_says_nothing_of_its_end_by_sigterm_ends_with_a_line(capsys) -> None:
    with heeded_signals():  # other tests of this process may have left a handler
        assert interrupted_by_sigterm(interrupted, "tailor evaluate") == 143
        assert capsys.readouterr().err == "tailor evaluate: ended by SIGTERM\n"
        assert interrupted_by_sigterm(lambda: 1, "tailor evaluate") == 1
        assert signal.getsignal(signal.SIGTERM) == signal.SIG_DFL


def test_an_interrupt_is_for_the_process_that_waits() -> None:
    assert in_order(completed(is_blocked, [(0,), (1,)], 2)) == [True, True]
    assert not is_blocked(0)


@pytest.mark.parametrize(
    ("number", "whole_group", "code"),
    [(signal.SIGINT, True, 130), (signal.SIGTERM, True, 143), (signal.SIGTERM, False, 143)],
)
def test_workers_that_are_interrupted_while_they_start_print_nothing(number, whole_group, code, tmp_path: Path) -> None:
    command = tailor(
        "gather", "agilo", "goToPose", "--episodes", "500", "--jobs", "2", "--out", str(tmp_path), "--json"
    )
    running = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, cwd=ROOT, start_new_session=True)
    deadline = time.monotonic() + PATIENCE_S
    while not workers_of(running.pid):
        assert time.monotonic() < deadline
        assert running.poll() is None
    workers = workers_of(running.pid)
    (os.killpg if whole_group else os.kill)(running.pid, number)
    _, errors = running.communicate(timeout=PATIENCE_S)
    assert running.returncode == code
    assert not [each for each in workers if Path(f"/proc/{each}/exe").exists()], "none outlives it"
    assert errors.replace("\n", "").replace(" ", "") == f"{tmp_path}/goToPose:kept0of500;--resumecontinues"


def test_no_worker_outlives_a_command_that_is_killed(tmp_path: Path) -> None:
    """Idle ones would keep memory and standard output for minutes: a pipe behind the command would wait for them."""
    command = tailor(
        "gather", "agilo", "goToPose", "--episodes", "2000", "--jobs", "2", "--out", str(tmp_path), "--json"
    )
    running = subprocess.Popen(command, stdout=subprocess.PIPE, cwd=ROOT, start_new_session=True)
    try:
        deadline = time.monotonic() + PATIENCE_S
        while not list(tmp_path.glob("goToPose/part-*.parquet")):
            assert time.monotonic() < deadline
            time.sleep(0.05)
        assert len(workers_of(running.pid)) == 2
        running.kill()
        running.communicate(timeout=PATIENCE_S)  # until nobody holds the pipe
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(running.pid, signal.SIGKILL)
    assert running.returncode == -signal.SIGKILL


@pytest.mark.parametrize(
    ("error", "name", "killing", "printed"),
    [
        (KeyError(1), "ExecutorManagerThread", True, False),
        (KeyError(1), "ExecutorManagerThread", False, True),
        (ValueError(), "ExecutorManagerThread", True, True),
        (KeyError(1), "another", True, True),
    ],
)
def test_only_the_manager_of_workers_that_are_killed_says_nothing(monkeypatch, error, name, killing, printed) -> None:
    seen: list[threading.ExceptHookArgs] = []
    monkeypatch.setattr(threading, "excepthook", seen.append)
    quieten_shutdown()
    quieten_shutdown()  # as each use of the pool

    def fail() -> None:
        raise error

    thread = threading.Thread(target=fail, name=name)
    thread.executor_flags = SimpleNamespace(kill_workers=killing)  # type: ignore[attr-defined]
    thread.start()
    thread.join()
    assert len(seen) == printed
