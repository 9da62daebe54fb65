"""What an external planner starts ends with it, or with the process that asked it, whatever it does to get away."""

import os
import signal
import subprocess
import sys

import pytest

from tailor.runtime.processes.planner_process import PlannerProcess
from tests.faults.supervision.test_orphans import PLANNER
from tests.faults.supervision.test_planner_process import LIMIT_S, program, run
from tests.support.patience import first_line, gone, is_alive, wait_until
from tests.support.stalls import repeat_on_stall

DAEMON = """
def started(name, code):
    path = os.path.join(os.path.dirname(sys.argv[0]), name)
    middle = "import subprocess, sys; subprocess.Popen([sys.executable, '-c', sys.argv[2], sys.argv[1]])"
    subprocess.run([sys.executable, "-c", middle, path + ".new", code])
    while not os.path.exists(path + ".new") or not open(path + ".new").read(): time.sleep(0.01)
    os.rename(path + ".new", path)
SLEEP = "import os, sys, time; os.setsid(); print(os.getpid(), file=open(sys.argv[1], 'w'), flush=True); time.sleep(60)"
started("daemon", SLEEP)
"""


def daemon_of(tmp_path):
    """Process id of the daemon that the planner has started: by a second fork, in a session of its own."""
    return int((tmp_path / "daemon").read_text())


@pytest.mark.promise("P8")
def test_a_daemon_that_a_planner_leaves_behind_is_killed(tmp_path):
    _, answer, _ = run(program(tmp_path, f"{DAEMON}\nprint('a plan')"))
    assert (answer.outcome, answer.output) == ("answered", "a plan\n")
    assert not is_alive(daemon_of(tmp_path)), "it has ended before the answer is there"


@pytest.mark.promise("P8")
def test_a_daemon_of_a_planner_that_hangs_is_killed(tmp_path):
    limits = iter((1.5, 6.0, 24.0))  # it needs time to start

    def started():
        _, answer, _ = run(program(tmp_path, f"{DAEMON}\ntime.sleep(60)"), next(limits))
        assert (tmp_path / "daemon").exists()
        return answer

    answer = repeat_on_stall(3, started)
    assert answer.outcome == "timeout"
    assert gone(daemon_of(tmp_path))


@pytest.mark.promise("P8")
def test_what_a_planner_started_ends_with_the_process_that_asked_it(tmp_path):
    command = program(tmp_path, f"{DAEMON}\ntime.sleep(60)")
    parent = subprocess.Popen(
        [sys.executable, "-c", PLANNER, command], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    first_line(parent.stdout)
    wait_until((tmp_path / "daemon").exists, "the planner has started a daemon")
    assert is_alive(daemon_of(tmp_path))
    parent.kill()
    parent.wait()
    assert gone(daemon_of(tmp_path))


def test_what_watches_over_a_planner_kills_it_although_somebody_has_stopped_that(tmp_path):
    child = PlannerProcess(program(tmp_path, f"{DAEMON}\ntime.sleep(60)"), "", "", LIMIT_S)
    wait_until((tmp_path / "daemon").exists, "the planner has started a daemon")
    os.kill(child.pid, signal.SIGSTOP)
    child.kill()
    assert gone(daemon_of(tmp_path))
    assert gone(child.pid)


def test_a_planner_that_ends_its_whole_group_ends_as_one_that_crashes(tmp_path):
    """As `trap "kill 0" EXIT` of a shell's script; what watches over it is in no such group."""
    _, answer, _ = run(program(tmp_path, f"{DAEMON}\nos.kill(0, 9)\ntime.sleep(60)"))
    assert (answer.outcome, answer.reason) == ("crashed", "the planner ended with code -9")
    assert not is_alive(daemon_of(tmp_path))


def test_a_planner_has_no_input_its_limits_and_the_default_actions_of_signals(tmp_path):
    body = """
import resource
print(sys.stdin.read() == "", resource.getrlimit(resource.RLIMIT_AS), open("/proc/self/status").read())"""
    _, answer, _ = run(program(tmp_path, body))
    assert answer.output.startswith("True (2147483648, 2147483648) ")
    (ignored,) = (int(line.split()[1], 16) for line in answer.output.splitlines() if line.startswith("SigIgn"))
    between = sum(1 << number - 1 for number in (signal.SIGHUP, signal.SIGINT, signal.SIGTERM))
    assert not ignored & between, "what the process between ignores; others may be inherited from whoever runs this"


def test_a_program_that_cannot_be_executed_has_its_reason(tmp_path):
    broken = tmp_path / "planner"
    broken.write_text("#!/no/such/interpreter\n")
    broken.chmod(0o755)
    _, answer, _ = run(str(broken))
    assert answer.reason == f"the planner ended with code 127 (stderr: '{broken}: No such file or directory')"
