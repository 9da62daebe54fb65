"""A launcher killed with -9 leaves no process: what the death signal does not end is killed three seconds later."""

import errno
import os
import random
import signal
import subprocess
import sys
import time

import pytest

from tailor.runtime.processes import orphans
from tailor.runtime.processes.child import STOP_S, Child, tailor
from tests.support.bus_system import free_endpoint
from tests.support.patience import first_line, is_alive, wait_until

LIMIT_S = STOP_S + 1.0
PARENT = """
import sys
from tailor.runtime.processes.child import Child
print(*(Child("child", [sys.executable, "-c", code]).pid for code in sys.argv[1:]), flush=True)
sys.stdin.read()
"""
MEEK = "import time; open('meek', 'w'); time.sleep(600)"
DEAF = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); open('deaf', 'w'); time.sleep(600)"
TIDY = """
import signal, sys, time
def tidy_up(*_):
    time.sleep(1.0)
    open("tidied up", "w")
    sys.exit()
signal.signal(signal.SIGTERM, tidy_up)
open("tidy", "w")
time.sleep(600)
"""
PLANNER = """
import sys
from tailor.runtime.processes.planner_process import PlannerProcess
print(PlannerProcess(sys.argv[1], "", "", 600.0).pid, flush=True)
sys.stdin.read()
"""


def parent_of(folder, *codes, program=PARENT):
    """A process with children that run these programs in a folder; its Popen and their process ids."""
    command = [sys.executable, "-c", program, *codes]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=folder)
    return process, [int(word) for word in first_line(process.stdout).split()]


def seconds_to_the_end(parent, pids):
    """From kill -9 of the parent on."""
    began_s = time.monotonic()
    parent.kill()
    parent.wait(10.0)
    wait_until(lambda: not any(map(is_alive, pids)), "end of all children", 30.0)
    return time.monotonic() - began_s


@pytest.mark.promise("P10")
@pytest.mark.parametrize("tries", [3, pytest.param(20, marks=pytest.mark.slow)])
def test_children_that_are_stopped_or_ignore_sigterm_end_with_their_launcher(tries, tmp_path, measured):
    for number in range(tries):
        folder = tmp_path / str(number)
        folder.mkdir()
        parent, pids = parent_of(folder, MEEK, DEAF, TIDY)
        wait_until(lambda: len(list(folder.iterdir())) == 3, "children")  # noqa: B023
        os.kill(pids[0], signal.SIGSTOP)
        took_s = seconds_to_the_end(parent, pids)
        assert took_s > STOP_S - 0.5, "a protection that ends them sooner is another one"
        measured.add(took_s, LIMIT_S)
        assert (folder / "tidied up").exists(), "the one that obeys has time for it"


@pytest.mark.promise("P10")
def test_an_external_planner_ends_at_once_with_its_executive(tmp_path, measured):
    deaf = tmp_path / "planner"
    deaf.write_text(f"#!{sys.executable}\n{DEAF}\n")
    deaf.chmod(0o755)
    parent, pids = parent_of(tmp_path, str(deaf), program=PLANNER)
    wait_until((tmp_path / "deaf").exists, "planner")
    os.kill(pids[0], signal.SIGSTOP)
    measured.add(seconds_to_the_end(parent, pids), 1.0)


@pytest.mark.promise("P10")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("tries", [1, pytest.param(20, marks=pytest.mark.slow)])
def test_a_killed_system_leaves_no_process_although_one_is_stopped(tries, tmp_path, measured):
    for number in range(tries):
        endpoint = free_endpoint()
        record = ("--record", str(tmp_path / f"{number}.mcap"))
        up = Child("up", tailor("up", "soccer", "--connect", endpoint, *record), subprocess.DEVNULL)
        name = ("record", "sim", "executive")[number % 3]
        wait_until(lambda: child_of(up.pid, "executive"), "executive")  # noqa: B023
        time.sleep(random.Random(number).uniform(0.0, 2.0))
        pids = children_of(up.pid)
        os.kill(child_of(up.pid, name), signal.SIGSTOP)
        measured.add(seconds_to_the_end(up, pids), LIMIT_S)


def child_of(pid, command):
    """Process id of the child that runs this tailor command, or None."""
    for child in children_of(pid):
        with open(f"/proc/{child}/cmdline") as words:
            if f"tailor.tools.main\0{command}\0" in words.read():
                return child
    return None


def children_of(pid):
    with open(f"/proc/{pid}/task/{pid}/children") as listed:
        return [int(word) for word in listed.read().split()]


def test_a_watch_that_cannot_be_started_leaves_no_descriptor(monkeypatch):
    def refused(*arguments, **options):
        raise OSError(errno.EAGAIN, "Resource temporarily unavailable")

    monkeypatch.setattr(orphans.subprocess, "Popen", refused)
    before = len(os.listdir("/proc/self/fd"))
    with pytest.raises(OSError, match="temporarily unavailable") as raised:  # its traceback holds the watch
        orphans._OrphanWatch()
    assert len(os.listdir("/proc/self/fd")) == before, raised
