"""An external planner behaves, hangs, crashes, prints garbage or floods: nothing blocks, no process is left behind."""

import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from tailor.executive.planning import PlanTextError, parse_plan, validate
from tailor.runtime.processes.planner_process import MAX_OUTPUT_BYTES, PlannerProcess
from tailor.schemas.errors import UsageError
from tests.support.patience import PATIENCE_S, first_line, gone, is_alive, wait_until
from tests.support.planning.planning_problems import DATA, own, printed
from tests.support.stalls import repeat_on_stall

ROOT = Path(__file__).resolve().parents[3]
LIMIT_S = 30.0  # for those that end by themselves
POLL_LIMIT_S = 0.05  # half a tick; a poll takes microseconds, the rest is for a busy machine


def program(tmp_path, body):
    """The command of a stand-in for vhpop."""
    path = tmp_path / "vhpop.py"
    path.write_text(f"import os, subprocess, sys, time\n{body}\n")
    return f"{sys.executable} {path}"


def run(command, limit_s=LIMIT_S):
    """The answer, after polling as a tick would; and the longest poll in seconds."""
    domain, problem = ((DATA / "own" / name).read_text() for name in ("kitchen-domain.pddl", "kitchen-s1.pddl"))
    child = PlannerProcess(command, domain, problem, limit_s)
    longest, give_up = 0.0, time.monotonic() + limit_s + PATIENCE_S
    while time.monotonic() < give_up:
        before = time.perf_counter()
        answer = child.poll()
        longest = max(longest, time.perf_counter() - before)
        if answer is not None:
            return child, answer, longest
        time.sleep(0.005)
    raise AssertionError("the planner never ended")


def run_without_blocking(command, limit_s=LIMIT_S, longest_s=POLL_LIMIT_S):
    """The child and its answer, after polls of which none took longer than it may."""

    def attempt():
        child, answer, longest = run(command, limit_s)
        assert longest < longest_s
        return child, answer

    return repeat_on_stall(3, attempt)


def test_a_planner_that_behaves_well_gets_its_plan_parsed_and_validated(tmp_path):
    text = printed("kitchen-s1.ground.links")
    body = f"assert len(sys.argv) == 4 and sys.argv[1] == '-g', sys.argv\nopen(sys.argv[2]); sys.stdout.write({text!r})"
    _, answer = run_without_blocking(program(tmp_path, body) + " -g")
    assert answer.outcome == "answered"
    assert validate(parse_plan(answer.output), *own("kitchen-s1")) == ""


@pytest.mark.promise("P8")
def test_a_planner_that_hangs_is_killed_with_its_whole_group(tmp_path):
    body = """
grandchild = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])
print(";pids", os.getpid(), grandchild.pid, flush=True)
time.sleep(60)"""
    limits = iter((1.5, 6.0, 24.0))  # it needs time to start

    def both_started():
        child, answer = run_without_blocking(program(tmp_path, body), next(limits))
        pids = [int(word) for word in answer.output.split()[1:]]
        assert len(pids) == 2
        return child, answer, pids

    child, answer, pids = repeat_on_stall(3, both_started)
    assert answer.outcome == "timeout"
    assert all(gone(pid) for pid in pids)
    assert gone(child.pid)


@pytest.mark.promise("P8")
def test_what_a_wrapper_started_in_a_group_of_its_own_is_killed_as_well(tmp_path):
    """`timeout` is such a wrapper."""
    body = """
grandchild = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"], process_group=0)
print(";pid", grandchild.pid, flush=True)
time.sleep(60)"""
    limits = iter((1.5, 6.0, 24.0))

    def started():
        _, answer = run_without_blocking(program(tmp_path, body), next(limits))
        _, pid = answer.output.split()
        return answer, int(pid)

    answer, pid = repeat_on_stall(3, started)
    assert answer.outcome == "timeout"
    assert gone(pid)


@pytest.mark.promise("P8")
def test_a_planner_that_ignores_signals_is_killed_as_well(tmp_path):
    body = "import signal\nfor s in (2, 15, 1): signal.signal(s, signal.SIG_IGN)\ntime.sleep(60)"
    child, answer, _ = run(program(tmp_path, body), limit_s=0.5)
    assert answer.outcome == "timeout"
    assert gone(child.pid)


WRITER = """
import itertools, os, sys
for number in itertools.count():
    os.close(os.open(os.path.join(sys.argv[1], f"{number}"), os.O_CREAT))
    if number == 20000:
        print("many", flush=True)"""


@pytest.mark.promise("P8")
def test_files_that_a_planner_writes_beside_its_problem_hold_up_no_poll_and_are_removed(tmp_path):
    """The writer has a group of its own, as below `timeout`, so it still writes when the planner has been killed."""
    body = f"""
folder = os.path.dirname(sys.argv[-1])
writer = subprocess.Popen([sys.executable, "-c", {WRITER!r}, folder], process_group=0, stdout=subprocess.PIPE)
writer.stdout.readline()
print(folder, flush=True)
time.sleep(60)"""
    limits = iter((3.0, 12.0, 48.0))

    def written():
        _, answer = run_without_blocking(program(tmp_path, body), next(limits))
        assert answer.outcome == "timeout"
        assert "tailor-planner-" in answer.output
        return Path(answer.output.strip())

    folder = repeat_on_stall(3, written)
    wait_until(lambda: not folder.exists(), "the files are removed")


@pytest.fixture
def without_threads(monkeypatch):
    """No thread can be started; what is left to the end of this process."""

    def refuse(thread):
        raise RuntimeError("can't start new thread")

    at_exit = []
    monkeypatch.setattr(threading.Thread, "start", refuse)
    monkeypatch.setattr("atexit.register", at_exit.append)
    return at_exit


@pytest.mark.promise("P8")
def test_a_planner_is_killed_with_its_whole_session_where_no_thread_can_be_started(tmp_path, without_threads):
    body = """
other = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"], process_group=0)
folder = os.path.dirname(sys.argv[1])
with open(folder + "/other", "w") as file: print(other.pid, file=file)
os.rename(folder + "/other", folder + "/started")
time.sleep(60)"""
    child = PlannerProcess(program(tmp_path, body), "", "", LIMIT_S)
    folder = Path(child._folder.name)
    wait_until((folder / "started").exists, "the planner has started another process")
    other = int((folder / "started").read_text())
    child.kill()
    assert child.poll().outcome == "timeout"
    assert gone(child.pid)
    assert gone(other)
    for tidy in without_threads:
        tidy()
    assert not folder.exists()


def test_a_planner_has_its_answer_where_no_thread_can_be_started(tmp_path, without_threads):
    _, answer, _ = run(program(tmp_path, "print('a plan')"))
    assert (answer.outcome, answer.output) == ("answered", "a plan\n")
    assert len(without_threads) == 1


def test_a_planner_that_crashes_has_no_plan(tmp_path):
    _, answer, _ = run(program(tmp_path, "os.abort()"))
    assert answer.outcome == "crashed"
    assert "code -6" in answer.reason
    with pytest.raises(PlanTextError):
        parse_plan(answer.output)


def test_a_planner_that_prints_garbage_has_no_plan(tmp_path):
    _, answer, _ = run(program(tmp_path, "sys.stdout.buffer.write(os.urandom(5000))"))
    assert answer.outcome == "answered"
    with pytest.raises(PlanTextError):
        parse_plan(answer.output)


@pytest.mark.promise("P8")
def test_a_planner_that_floods_is_stopped_at_a_limit(tmp_path):
    flood = program(tmp_path, "while True: sys.stdout.write('x' * 65536)")
    child, answer = run_without_blocking(flood, longest_s=1.0)
    assert answer.outcome == "flood"
    assert len(answer.output) <= MAX_OUTPUT_BYTES
    assert gone(child.pid)


def test_a_child_that_outlives_its_planner_is_killed(tmp_path):
    body = """
grandchild = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])
print(grandchild.pid)"""
    _, answer, _ = run(program(tmp_path, body))
    assert answer.outcome == "answered"
    assert gone(int(answer.output))


@pytest.mark.promise("P8")
def test_a_planner_that_eats_memory_runs_into_a_limit(tmp_path):
    limited = "while resource.getrlimit(resource.RLIMIT_AS)[0] < 0: time.sleep(0.01)"  # it is set from outside
    _, answer, _ = run(program(tmp_path, f"import resource\n{limited}\nheap = bytearray(4 << 30)\nprint('plenty')"))
    assert answer.outcome in ("answered", "crashed")
    assert "plenty" not in answer.output


@pytest.mark.promise("P8")
def test_a_planner_dies_with_the_process_that_asked_it(tmp_path):
    body = f"""
import sys
from tailor.runtime.processes.planner_process import PlannerProcess
child = PlannerProcess({program(tmp_path, "time.sleep(60)")!r}, "", "", 60.0)
print(child.pid, flush=True)
time.sleep(60)"""
    script = tmp_path / "parent.py"
    script.write_text(f"import time\n{body}\n")
    parent = subprocess.Popen([sys.executable, script], stdout=subprocess.PIPE, text=True, cwd=ROOT)
    pid = int(first_line(parent.stdout))
    time.sleep(0.5)
    assert is_alive(pid)
    parent.kill()
    parent.wait()
    assert gone(pid)


def test_killing_early_leaves_nothing_and_may_be_repeated(tmp_path):
    child = PlannerProcess(program(tmp_path, "time.sleep(60)"), "", "", LIMIT_S)
    child.kill()
    child.kill()
    assert child.poll().outcome == "timeout"
    assert gone(child.pid)


@pytest.mark.parametrize("command", ["", "no-such-planner-anywhere", "/", "'unbalanced"])
def test_a_command_that_cannot_be_started_is_reported(command):
    with pytest.raises(UsageError, match="cannot be started"):
        PlannerProcess(command, "", "", LIMIT_S)
