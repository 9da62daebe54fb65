"""What ends `tailor up --once` besides a result."""

from collections import Counter
from dataclasses import replace

import pytest

from tailor.executive.composition import ExecutiveConfig
from tailor.schemas.messages import DriverState, ExecStatus
from tailor.schemas.own import example
from tailor.tools.cli.systems.bus_settings import BusSettings
from tailor.tools.launch.goal_advice import next_step
from tailor.tools.launch.once import OnceWatch
from tailor.tools.launch.processes import LaunchConfig


class Run:
    def __init__(self, hardware=""):
        config = LaunchConfig(ExecutiveConfig("soccer", "approach"), BusSettings(), once=True, hardware=hardware)
        self.driver, self.starts = config.driver, Counter({"executive": 1, config.driver: 1})
        self.watch = OnceWatch(config, self.starts.__getitem__)

    def restart(self, name):
        self.starts[name] += 1

    def hear(self, mode, reason=""):
        self.watch.hear(DriverState(0, mode, reason, "", 7, "", 0))


@pytest.mark.parametrize("hardware", ["", "robot.toml"])
@pytest.mark.parametrize("mode", ["stopped", "estopped"])
def test_a_stop_ends_the_run_unless_people_arm_the_robot_again_before_it_was_noticed(hardware, mode):
    run = Run(hardware)
    run.hear("armed")
    assert run.watch.failure() == ""
    run.hear(mode, "e-stop")
    assert run.watch.failure() == f"failed: the driver is {mode}: e-stop"
    run.hear("armed")
    assert run.watch.failure() == ""


def test_hardware_that_is_stopped_before_people_have_armed_it_waits_for_them_as_one_that_is_disarmed():
    """`open` had failed once, e.g. since the robot was switched on later: the run ended before anybody could arm it."""
    run = Run("robot.toml")
    run.hear("stopped", "driver fault")
    assert run.watch.failure() == ""
    run.hear("armed")
    run.hear("stopped", "driver fault")
    assert run.watch.failure() == "failed: the driver is stopped: driver fault"


@pytest.mark.parametrize(("hardware", "mode"), [("robot.toml", "estopped"), ("", "stopped"), ("", "estopped")])
def test_a_stop_by_people_ends_a_run_that_nobody_has_armed_and_any_stop_one_that_arms_itself(hardware, mode):
    run = Run(hardware)
    run.hear(mode, "e-stop")
    assert run.watch.failure() == f"failed: the driver is {mode}: e-stop"


def test_a_fault_of_the_executive_ends_the_run_unless_people_set_another_goal_before_it_was_noticed():
    """It has no result, so the run stood for ever."""
    run, fault = (
        Run(),
        replace(example(ExecStatus), mode="FAULT", reason="repeated failure", detail="goToPose", result=""),
    )
    run.watch.hear_executive(fault)
    assert run.watch.failure() == "failed: repeated failure: goToPose"
    run.watch.hear_executive(replace(fault, mode="EXECUTING"))
    assert run.watch.failure() == ""


@pytest.mark.parametrize(
    ("mode", "result", "line"),
    [
        ("EXECUTING", "", ""),
        ("READY", "achieved", 'achieved. next: tailor goal "(at a)" pursues a goal; Ctrl-C stops the system'),
        (
            "FAULT",
            "",
            'FAULT: stuck. next: remove the cause, then tailor goal "(at a)" pursues a goal; Ctrl-C stops the system',
        ),
    ],
)
def test_a_run_that_does_not_end_by_itself_names_the_next_step(mode, result, line):
    status = replace(example(ExecStatus), mode=mode, reason="stuck", detail="", goal="(at a)")
    assert next_step(status, result) == line


@pytest.mark.parametrize("hardware", ["", "robot.toml"])
def test_an_executive_that_was_started_again_ends_the_run(hardware):
    run = Run(hardware)
    run.restart("executive")
    assert run.watch.failure() == "failed: the executive was started again"


def test_a_simulator_that_was_started_again_ends_the_run_armed_or_not():
    run = Run()
    run.restart(run.driver)
    assert run.watch.failure() == "failed: the driver was started again"


def test_a_driver_of_hardware_that_was_started_again_ends_the_run_once_people_had_armed_it():
    run = Run("robot.toml")
    run.hear("disarmed", "just started")
    run.restart(run.driver)
    assert run.watch.failure() == "", "people have not armed it yet"
    run.hear("armed")
    assert run.watch.failure() == ""
    run.restart(run.driver)
    run.hear("disarmed", "just started")
    assert run.watch.failure() == "failed: the driver was started again"
