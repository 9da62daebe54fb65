"""Restarting, and children that cannot outlive their parent."""

import errno
import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager

import pytest

from tailor.runtime.processes import child as child_module
from tailor.runtime.processes.child import Child, stopped_in_order
from tailor.runtime.processes.notify_socket import Report
from tailor.runtime.processes.restart import Restart
from tailor.runtime.processes.supervised import STARTUP_NS, STOPPING_NS, ProcessSpec, State
from tailor.runtime.processes.supervisor import Supervisor
from tailor.runtime.stopping import SIGNALS, stop_on_signals
from tests.support.injection.signals import heeded_signals
from tests.support.patience import PATIENCE_S, first_line, gone, is_alive, wait_until

S = 1_000_000_000
MS = 1_000_000


@pytest.mark.promise("P2")
def test_the_back_off_doubles_up_to_five_seconds_and_forgets_after_a_minute():
    restart, delays = Restart(), []
    for k in range(5):
        restart.started(k * S)
        delays.append(restart.delay_ns(k * S) / S)
    assert delays == [0.2, 0.4, 0.8, 1.6, 3.2]
    assert restart.delay_ns(100 * S) == 0.2 * S


def test_five_starts_within_a_minute_are_a_crash_loop():
    restart = Restart()
    for k in range(4):
        restart.started(k * S)
    assert not restart.exhausted(5 * S)
    restart.started(10 * S)
    assert restart.exhausted(59 * S)
    assert not restart.exhausted(60 * S)


class FakeChild:
    def __init__(self, name, argv):
        self.name, self.argv, self.code, self.killed, self.pid = name, argv, None, 0, 1000 + len(FakeChild.made)
        self.reported = Report()
        FakeChild.made.append(self)

    made: list = []
    code_if_killed: int | None = -9

    def exit_code(self):
        return self.code

    def report(self):
        reported, self.reported = self.reported, Report()
        return reported

    def kill(self, timeout_s):
        assert timeout_s == 0.0, "the supervisor never blocks"
        self.killed, self.code = self.killed + 1, self.code_if_killed

    def stop(self):
        self.code = 0
        FakeChild.stopped.append(self.name)

    stopped: list = []


def refused(name, argv):
    raise OSError(errno.ENOMEM, os.strerror(errno.ENOMEM))


@pytest.fixture
def supervisor():
    FakeChild.made, FakeChild.stopped, reported = [], [], []
    supervisor = Supervisor(reported.append, FakeChild)
    supervisor.reported = reported
    return supervisor


def test_a_dead_child_is_started_again_after_its_back_off(supervisor):
    supervisor.start(ProcessSpec("executive", ["x"]), 0)
    FakeChild.made[0].code = -9
    supervisor.poll(1 * S)
    supervisor.poll(1 * S + 199 * MS)
    assert len(FakeChild.made) == 1
    supervisor.poll(1 * S + 200 * MS)
    assert len(FakeChild.made) == 2
    assert supervisor.reported == ["executive ended with -9; starting again in 0.2 s"]
    assert supervisor.state("executive") is State.STARTING


def test_people_are_told_what_a_restart_lacks(supervisor):
    supervisor.start(ProcessSpec("executive", ["x"], restart_note=", without a goal"), 0)
    assert supervisor.starts("executive") == 1
    FakeChild.made[0].code = -9
    supervisor.poll(1 * S)
    supervisor.poll(2 * S)
    assert supervisor.reported == ["executive ended with -9; starting again in 0.2 s, without a goal"]
    assert supervisor.starts("executive") == 2


def test_a_child_without_which_nothing_begins_is_announced_no_second_start_that_never_comes(supervisor):
    supervisor.start(ProcessSpec("driver", ["x"], must_begin=True), 0)
    FakeChild.made[0].code = -9
    supervisor.poll(1 * S)
    supervisor.poll(9 * S)
    assert supervisor.reported == ["driver ended with -9; not started again"]
    assert (len(FakeChild.made), supervisor.state("driver")) == (1, State.ENDED)


def test_a_child_without_which_nothing_begins_is_started_again_once_it_was_ready(supervisor):
    supervisor.start(ProcessSpec("driver", ["x"], must_begin=True), 0)
    FakeChild.made[0].reported = Report(ready=True)
    supervisor.poll(1 * S)
    for k in (2, 12, 22):
        FakeChild.made[-1].code = -9
        supervisor.poll(k * S)
        supervisor.poll((k + 1) * S)
    assert (len(FakeChild.made), supervisor.state("driver")) == (4, State.STARTING)


@pytest.mark.promise("P2")
def test_a_crash_loop_is_given_up(supervisor):
    supervisor.start(ProcessSpec("executive", ["x"]), 0)
    for k in range(1, 400):
        FakeChild.made[-1].code = 1
        supervisor.poll(k * 100 * MS)
    assert len(FakeChild.made) == 5
    assert supervisor.state("executive") is State.ENDED
    assert supervisor.reported[-1] == "executive ended with 1; gave up: too many starts within a minute"


@pytest.mark.promise("P2")
def test_a_start_that_the_system_refuses_is_repeated_and_harms_no_other_child(supervisor, monkeypatch):
    supervisor.start(ProcessSpec("sim", ["y"]), 0)
    supervisor.start(ProcessSpec("executive", ["x"]), 0)
    FakeChild.made[1].code = -9
    supervisor.poll(S)
    monkeypatch.setattr(supervisor, "_launch", refused)
    supervisor.poll(S + 200 * MS)
    assert supervisor.reported[1:] == ["executive cannot be started: Cannot allocate memory; starting again in 0.4 s"]
    assert (supervisor.state("executive"), supervisor.state("sim")) == (State.WAITING, State.STARTING)
    monkeypatch.setattr(supervisor, "_launch", FakeChild)
    supervisor.poll(S + 600 * MS - 1)
    assert len(FakeChild.made) == 2
    supervisor.poll(S + 600 * MS)
    assert (len(FakeChild.made), supervisor.state("executive")) == (3, State.STARTING)


@pytest.mark.promise("P2")
def test_of_a_start_that_fails_half_way_nothing_is_left(tmp_path, monkeypatch):
    watched = []

    def refuse(pid):
        watched.append(pid)
        raise OSError(errno.EMFILE, os.strerror(errno.EMFILE))

    monkeypatch.setattr(child_module, "kill_if_orphaned", refuse)
    with pytest.raises(OSError, match="Too many open files"):
        Child("c", ["sleep", "60"], notify_folder=tmp_path)
    assert not is_alive(watched[0])
    assert list(tmp_path.iterdir()) == []


@pytest.mark.promise("P2")
def test_starts_that_the_system_refuses_count_as_a_crash_loop(supervisor, monkeypatch):
    supervisor.start(ProcessSpec("executive", ["x"]), 0)
    FakeChild.made[0].code = -9
    monkeypatch.setattr(supervisor, "_launch", refused)
    for k in range(1, 400):
        supervisor.poll(k * 100 * MS)
    assert supervisor.state("executive") is State.ENDED
    assert len(supervisor.reported) == 5
    assert supervisor.reported[-1].endswith("Cannot allocate memory; gave up: too many starts within a minute")


@pytest.mark.parametrize(("restarts", "code"), [(False, 1), (True, 0), (True, 2)])
def test_a_process_that_ended_well_or_for_bad_input_or_must_not_restart_stays_ended(supervisor, restarts, code):
    supervisor.start(ProcessSpec("sim", ["x"], restarts=restarts), 0)
    FakeChild.made[0].code = code
    supervisor.poll(1)
    supervisor.poll(10 * S)
    assert (len(FakeChild.made), supervisor.state("sim")) == (1, State.ENDED)


def test_a_process_that_refuses_its_input_is_told_from_one_that_ended_otherwise_or_later(supervisor):
    for code, ready in ((2, False), (1, False), (2, True)):
        supervisor.start(ProcessSpec("sim", ["x"], must_begin=True, restarts=False), 0)
        assert not supervisor.refused("sim")
        FakeChild.made[-1].reported = Report(ready=ready)
        supervisor.poll(1)
        FakeChild.made[-1].code = code
        supervisor.poll(2)
        assert supervisor.refused("sim") == ((code, ready) == (2, False))


@pytest.mark.promise("P2")
def test_a_silent_child_is_killed_after_a_second_and_a_live_one_is_not(supervisor):
    supervisor.start(ProcessSpec("executive", ["x"], silence_ns=S), 0)
    FakeChild.made[0].reported = Report(ready=True)
    for now_ns in range(0, 30 * S, 50 * MS):
        if now_ns % S == 0 and now_ns > 0:
            FakeChild.made[0].reported = Report(alive=True)
        supervisor.poll(now_ns)
    supervisor.poll(30 * S)
    assert not FakeChild.made[0].killed
    supervisor.poll(30 * S + 1)
    assert FakeChild.made[0].killed
    assert supervisor.reported == ["executive gave no sign of life; killed"]


@pytest.mark.parametrize("paused_s", [0.6, 3.0, 3600.0])
def test_a_paused_supervisor_does_not_time_out_its_children(supervisor, paused_s):
    supervisor.start(ProcessSpec("executive", ["x"], silence_ns=S), 0)
    FakeChild.made[0].reported = Report(ready=True)
    supervisor.poll(S)
    supervisor.poll(S + 100 * MS)
    on_ns = S + 100 * MS + round(paused_s * S)
    for now_ns in range(on_ns, on_ns + 900 * MS, 50 * MS):
        supervisor.poll(now_ns)
    assert not FakeChild.made[0].killed
    supervisor.poll(on_ns + 900 * MS + 1)
    assert FakeChild.made[0].killed


def test_a_child_that_ended_for_good_is_reported(supervisor):
    supervisor.start(ProcessSpec("record", ["x"], restarts=False), 0)
    FakeChild.made[0].code = -9
    supervisor.poll(S)
    supervisor.poll(2 * S)
    assert supervisor.reported == ["record ended with -9; not started again"]


@pytest.mark.parametrize(("restarts", "reported"), [(True, ["gateway ended with 0; not started again"]), (False, [])])
def test_a_child_that_was_to_run_on_and_ended_in_order_is_reported(supervisor, restarts, reported):
    """A gateway that somebody had sent SIGTERM was missed by those alone whom it let in, e.g. to a remote e-stop."""
    supervisor.start(ProcessSpec("gateway", ["x"], restarts=restarts), 0)
    FakeChild.made[0].code = 0
    supervisor.poll(S)
    supervisor.poll(9 * S)
    assert supervisor.reported == reported
    assert supervisor.state("gateway") is State.ENDED


@pytest.mark.promise("P2")
def test_a_child_without_any_sign_of_life_is_killed_at_the_start_up_deadline(supervisor):
    supervisor.start(ProcessSpec("executive", ["x"], silence_ns=S), 0)
    for now_ns in range(0, STARTUP_NS + 1, 100 * MS):
        FakeChild.made[0].reported = Report(alive=True)  # of a loop that turns before it is ready
        supervisor.poll(now_ns)
    assert (FakeChild.made[0].killed, supervisor.state("executive")) == (0, State.STARTING)
    supervisor.poll(STARTUP_NS + 1)
    assert FakeChild.made[0].killed
    assert supervisor.reported == ["executive was not ready within 30 s; killed"]


def test_a_child_that_is_stopping_has_time_for_it(supervisor):
    supervisor.start(ProcessSpec("executive", ["x"], silence_ns=S), 0)
    FakeChild.made[0].reported = Report(ready=True, stopping=True)
    for now_ns in range(0, STOPPING_NS + 1, 100 * MS):
        supervisor.poll(now_ns)
    assert not FakeChild.made[0].killed
    supervisor.poll(STOPPING_NS + 1)
    assert FakeChild.made[0].killed


def test_a_killed_child_that_the_kernel_does_not_end_is_reported_once(supervisor, monkeypatch):
    monkeypatch.setattr(FakeChild, "code_if_killed", None)
    supervisor.start(ProcessSpec("record", ["x"], silence_ns=S), 0)
    FakeChild.made[0].reported = Report(ready=True)
    for now_ns in range(0, 5 * S, 100 * MS):
        supervisor.poll(now_ns)
    assert (FakeChild.made[0].killed, len(supervisor.reported)) == (1, 1)
    assert supervisor.state("record") is State.RUNNING


def test_a_new_child_has_the_time_of_a_start_whenever_its_predecessor_was_heard(supervisor):
    supervisor.start(ProcessSpec("executive", ["x"], silence_ns=S), 0)
    FakeChild.made[0].reported = Report(ready=True)
    supervisor.poll(0)
    FakeChild.made[0].code = -9
    for now_ns in range(0, STARTUP_NS, 100 * MS):
        supervisor.poll(now_ns)
    assert (len(FakeChild.made), FakeChild.made[1].killed) == (2, 0)
    assert supervisor.state("executive") is State.STARTING


def test_the_executive_is_stopped_before_the_robot_and_the_recorder_last(supervisor):
    for name in ("record", "sim", "executive"):
        supervisor.start(ProcessSpec(name, ["x"]), 0)
    supervisor.stop()
    assert FakeChild.stopped == ["executive", "sim", "record"]


def test_each_start_gets_its_own_arguments(supervisor):
    spec = ProcessSpec("sim", ["x"], arguments=lambda start: ("--leave",) if start == 1 else (f"--start={start}",))
    supervisor.start(spec, 0)
    FakeChild.made[0].code = -9
    for now_ns in range(0, S, 50 * MS):
        supervisor.poll(now_ns)
    assert [child.argv for child in FakeChild.made] == [["x", "--leave"], ["x", "--start=2"]]


def test_the_states_of_all_processes_are_published(supervisor):
    supervisor.start(ProcessSpec("record", ["x"], restarts=False), 0)
    supervisor.start(ProcessSpec("sim", ["x"]), 0)
    FakeChild.made[0].reported = Report(ready=True)
    supervisor.poll(0)
    FakeChild.made[0].reported = Report(status="disk: full")
    for now_ns in range(0, S, 100 * MS):
        supervisor.poll(now_ns)

    def states(now_ns):
        return [(s.name, s.pid, s.state, s.starts, s.silent_s, s.status) for s in supervisor.states(now_ns)]

    assert states(2 * S) == [
        ("record", 1000, "running", 1, 2.0, "disk: full"),
        ("sim", 1001, "starting", 1, 2.0, ""),
    ]
    for child in FakeChild.made:
        child.code = -9
    supervisor.poll(2 * S)
    assert [state[2:5] for state in states(2 * S)] == [("ended", 1, 0.0), ("waiting", 1, 0.0)]
    supervisor.poll(3 * S)
    assert states(3 * S)[1] == ("sim", 1002, "starting", 2, 0.0, "")


@pytest.mark.promise("P10")
def test_a_child_ends_when_its_parent_is_killed():
    parent = (
        "from tailor.runtime.processes.child import Child; print(Child('c', ['sleep', '60']).pid, flush=True); input()"
    )
    process = subprocess.Popen([sys.executable, "-c", parent], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    child = int(first_line(process.stdout))
    time.sleep(0.2)
    assert is_alive(child)
    process.kill()
    process.wait()  # not for the end of its output, which the child holds open
    assert gone(child)
    for pipe in (process.stdin, process.stdout):
        pipe.close()


def test_a_child_has_a_session_of_its_own_so_that_ctrl_c_reaches_its_parent_alone():
    child = Child("c", ["sleep", "60"])
    try:
        assert os.getsid(child.pid) == child.pid != os.getsid(0)
    finally:
        child.kill()


def test_children_heed_signals_that_their_parent_ignores(tmp_path):
    """As one does that the script of a shell started in the background."""
    report = "import signal; print(*(signal.getsignal(n) is signal.SIG_IGN for n in (2, 15, 1)))"
    with handlers_kept(), (tmp_path / "out").open("w") as out:
        for number in SIGNALS:
            signal.signal(number, signal.SIG_IGN)
        assert Child("c", [sys.executable, "-c", report], out).wait(PATIENCE_S) == 0
    assert (tmp_path / "out").read_text() == "False False True\n", "nohup holds for the children, too"


@pytest.mark.promise("P10")
def test_children_are_stopped_in_reverse_order_and_one_that_ignores_it_is_killed(tmp_path):
    order = []

    class Noted(Child):
        def stop(self, timeout_s=PATIENCE_S):
            order.append(self.name)
            return super().stop(0.3 if self.name == "deaf" else timeout_s)

    deaf = (
        "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); print('deaf', flush=True); time.sleep(60)"
    )
    with stopped_in_order([]) as children:
        children.append(Noted("meek", ["sleep", "60"]))
        with (tmp_path / "out").open("w") as out:
            children.append(Noted("deaf", [sys.executable, "-c", deaf], out))
        wait_until(lambda: "deaf" in (tmp_path / "out").read_text(), "deafness")
    assert order == ["deaf", "meek"]
    assert [child.exit_code() for child in children] == [-signal.SIGTERM, -signal.SIGKILL]


def test_the_first_signal_only_requests_a_stop():
    for number in SIGNALS:
        with heeded_signals():
            stop = stop_on_signals()
            assert not stop.requested
            os.kill(os.getpid(), number)
            assert stop.requested
            assert signal.getsignal(number) == signal.SIG_DFL


def test_a_closing_terminal_requests_a_stop_but_not_under_nohup():
    with handlers_kept():
        signal.signal(signal.SIGHUP, signal.SIG_IGN)
        stop = stop_on_signals()
        os.kill(os.getpid(), signal.SIGHUP)
        assert not stop.requested
    assert signal.SIGHUP in SIGNALS


@contextmanager
def handlers_kept():
    before = {number: signal.getsignal(number) for number in SIGNALS}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
