"""What `tailor executive` and `tailor sim` print when people start them by hand."""

import itertools
import sys
import threading
import time
from dataclasses import replace

import pytest

from tailor.executive.core.modes import Mode
from tailor.executive.core.state import Arming, Result, State, Task
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.runtime.processes.notify import SILENT, Notifier
from tailor.schemas.messages import DriverState
from tailor.simnodes.driver import Driver
from tailor.simnodes.driver_spec import shipped_driver_spec
from tailor.simnodes.reasons import Reason as DriverReason
from tailor.tools.commands.run import executive, sim
from tailor.tools.launch.arming_advice import DriverLines, driver_line
from tailor.tools.launch.state_lines import seldom, state_lines
from tests.support.patience import wait_until


def test_a_line_is_printed_for_each_change_and_for_the_last_state(capsys):
    states = iter(["", "waiting 1.5 s", "waiting 1.7 s", "running"])
    current = [""]

    def text():
        current[0] = next(states, current[0])
        return current[0]

    with state_lines(text):
        wait_until(lambda: current[0] == "waiting 1.7 s", "the third state", 10)
    assert capsys.readouterr().out == "waiting 1.5 s\nrunning\n"


def test_a_text_that_changes_all_the_time_changes_at_once_and_then_seldom():
    """Forged odometry, a wrong field after the other, printed a line in every fifth of a second."""
    now_s, count = [100.0], itertools.count(1)
    text = seldom(lambda: f"refused {next(count)}" if now_s[0] > 100.0 else "", lambda: now_s[0])
    assert text() == ""
    shown = []
    for step in range(1, 251):
        now_s[0] = 100.0 + step / 10
        shown.append(text())
    assert (shown[0], shown[99], shown[-1]) == ("refused 1", "refused 1", "refused 3")
    assert len(set(shown)) == 3


def test_several_states_are_printed_by_one_thread_so_that_no_line_cuts_another(capsys):
    threads = set()

    def text(state):
        threads.add(threading.current_thread())
        return state

    with state_lines(lambda: text("waiting"), lambda: text("odom refused: x is nan")):
        wait_until(lambda: threads, "a state", 10)
    assert len(threads) == 1
    assert capsys.readouterr().out == "waiting\nodom refused: x is nan\n"


def test_lines_that_nobody_can_take_end_nothing(monkeypatch, capsys):
    """`tailor sim agilo | head -1`: a thread that died left a traceback and printed no later line."""
    died, written, texts = [], [], iter(["waiting"])
    monkeypatch.setattr(threading, "excepthook", died.append)
    with monkeypatch.context() as closed, state_lines(lambda: next(texts, "running" if written else "")):
        closed.setattr(sys.stdout, "write", lambda line: written.append(line) or _refuse())
        wait_until(lambda: written, "a line", 5)
        closed.undo()
        time.sleep(0.5)
    assert not died
    assert capsys.readouterr().out == "running\n"


def _refuse():
    raise BrokenPipeError


def test_under_a_supervisor_nothing_is_printed(capsys, tmp_path):
    assert Notifier(str(tmp_path / "socket")).supervised
    assert not SILENT.supervised
    with state_lines():
        assert "state lines" not in [thread.name for thread in threading.enumerate()]
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize(
    ("reason", "advice"),
    [
        (Reason.DRIVER_SILENT, "; `tailor sim agilo` or a driver of agilo is expected"),
        (Reason.DRIVER_NOT_ARMED, "; `tailor arm agilo` arms it"),
        (Reason.REPEATED_FAILURE, "; remove the cause, then `tailor goal` sends a goal"),
        (Reason.INPUT_STALE, ""),
    ],
)
def test_an_executive_that_waits_names_what_people_can_do(reason, advice):
    state = State(belief=None, command=(), cause=Cause(reason, "detail"))
    assert executive.state_line(state, "agilo") == f"DISARMED: {reason}: detail{advice}"


def test_an_executive_whose_driver_is_estopped_names_the_command_that_releases_it():
    driver = DriverState(0, "estopped", "e-stop", "", 1, "", 0)
    cause = Cause(Reason.DRIVER_NOT_ARMED, "estopped: e-stop")
    state = State(belief=None, command=(), cause=cause, arming=Arming(driver))
    assert executive.state_line(state, "agilo").endswith("; `tailor arm agilo --reset` arms it")


def test_an_executive_that_has_achieved_its_goal_names_the_next_step():
    state = State(belief=None, command=(), task=Task(result=Result.ACHIEVED))
    assert executive.state_line(state, "agilo") == "achieved; `tailor goal` sends another goal"


@pytest.mark.parametrize(
    ("mode", "reason", "detail"),
    [("stopped", "driver fault", "odom: silent for 0.5 s; not ready"), ("disarmed", "the driver ends", "")],
    ids=["not ready", "ending"],
)
def test_an_executive_whose_driver_would_not_obey_advises_nobody_to_arm_it(mode, reason, detail):
    driver = DriverState(0, mode, reason, detail, 1, "", 0)
    state = State(belief=None, command=(), cause=Cause(Reason.DRIVER_NOT_ARMED, "its reason"), arming=Arming(driver))
    assert executive.state_line(state, "agilo") == "DISARMED: driver not armed: its reason"


def test_an_executive_that_runs_once_ends_in_a_fault_as_well_as_with_a_result():
    """In a fault its task has no result: `tailor executive --once` stood for ever."""
    state = State(belief=None, command=(), task=Task(goal="(at a)", active=True))
    assert not executive._is_over(state)
    assert executive._is_over(replace(state, mode=Mode.FAULT, cause=Cause(Reason.REPEATED_FAILURE, "goToPose")))
    assert executive._is_over(replace(state, task=Task(result=Result.FAILED)))


def test_a_simulator_that_ends_advises_nobody_to_arm_it():
    guard = Driver(shipped_driver_spec("agilo"), 1).guard
    guard.disarm(DriverReason.SHUTDOWN)
    assert sim.state_line(guard, "agilo") == "disarmed: the driver ends"


def test_a_simulator_that_waits_names_the_command_that_arms_it():
    guard = Driver(shipped_driver_spec("agilo"), 1).guard
    assert sim.state_line(guard, "agilo") == "disarmed: just started; `tailor arm agilo` arms it for an executive"
    guard.arm(0, "a" * 32, 1)
    assert sim.state_line(guard, "agilo") == "armed: obeys aaaaaaaa"


@pytest.mark.parametrize(
    ("mode", "reason", "detail", "line"),
    [
        ("disarmed", "just started", "", "agilo is disarmed: just started (`tailor arm agilo` arms it)"),
        ("disarmed", "just started", "not ready: opening", "agilo is disarmed: just started: not ready: opening"),
        ("stopped", "driver fault", "no bus; not ready: x", "agilo is stopped: driver fault: no bus; not ready: x"),
        ("estopped", "e-stop", "", "agilo is estopped: e-stop (`tailor arm agilo --reset` arms it)"),
        ("disarmed", "the driver ends", "", "agilo is disarmed: the driver ends"),
        ("armed", "", "", "agilo is armed"),
    ],
)
def test_nobody_is_told_to_arm_a_driver_that_would_not_obey(mode, reason, detail, line):
    assert driver_line("agilo", DriverState(0, mode, reason, detail, 1, "", 0)) == line


STARTED = ("disarmed", "just started"), "agilo is disarmed: just started (`tailor arm agilo` arms it)"
ARMED = ("armed", ""), "agilo is armed"
ESTOPPED = ("estopped", "e-stop"), "agilo is estopped: e-stop (`tailor arm agilo --reset` arms it)"


@pytest.mark.parametrize(
    ("is_hardware", "states", "starts", "reported"),
    [
        (False, (STARTED, ARMED), 1, ()),
        (False, (STARTED, ARMED, ESTOPPED, ESTOPPED, ARMED), 1, (ESTOPPED, ARMED)),
        (False, (STARTED, STARTED, ARMED), 2, (STARTED, ARMED)),
        (True, (STARTED, ARMED, ESTOPPED), 1, (STARTED, ARMED, ESTOPPED)),
    ],
    ids=["by its executive", "after a stop", "started again", "hardware"],
)
def test_a_launcher_names_the_command_once_people_have_to_arm_its_driver(is_hardware, states, starts, reported):
    lines = []
    driver = DriverLines("agilo", is_hardware, lines.append)
    for (mode, reason), _ in states:
        driver.hear(DriverState(0, mode, reason, "", 1, "", 0), starts)
    assert lines == [line for _, line in reported]
