"""An axis that keeps its set-point, such as a gripper, is moved by nobody but an armed executive."""

import math
import threading
from dataclasses import replace

import pytest

from tailor.schemas.messages import ArmRequest, EStop, VelocityCommand
from tailor.simnodes.driver_spec import DriverSpec, SensorSpec
from tailor.simnodes.guard import Limit
from tailor.simnodes.hardware.device import Phase
from tests.support.patience import wait_until
from tests.unit.simnodes.hardware.faulty import Faulty
from tests.unit.simnodes.hardware.test_hardware_node import EXECUTIVE, PERSON, robot  # noqa: F401

# A velocity and, in the place of a turn rate, the width of a gripper that is closed at first.
SPEC = DriverSpec(
    "cmd_vel",
    ("v", "width"),
    (Limit(-1.0, 1.0), Limit(0.0, 0.12, kept=0.0)),
    timeout_ns=3_000_000_000,
    sensors=(SensorSpec("odom", 50.0),),
)


class Gripping(Faulty):
    """Its gripper is as wide as people have left it, or as it was set to."""

    def __init__(self, width=None):
        super().__init__()
        self.width, self.taken = width, []  # set-points that were written without an error

    def write(self, values):
        super().write(values)
        self.taken.append(values)

    def kept(self):
        return None if self.width is None else (0.0, self.width)


def widths(hardware):
    return {written[1] for written in hardware.written}


@pytest.mark.promise("P66")
def test_a_gripper_stays_as_people_have_left_it_until_the_robot_is_armed(robot):  # noqa: F811
    hardware = Gripping(0.08)
    driven = robot(hardware, spec=SPEC)
    wait_until(lambda: len(hardware.written) > 5, "set-points", 5)
    assert widths(hardware) == {0.08}
    hardware.width = 0.03  # by hand
    wait_until(lambda: hardware.written[-1] == (0.0, 0.03), "the width of now", 5)
    driven.send(ArmRequest(True, False, EXECUTIVE, 0), "arm_request", PERSON)
    driven.send(VelocityCommand(0, 0.5, 0.1), "cmd_vel")
    wait_until(lambda: hardware.written[-1] == (0.5, 0.1), "motion", 5)
    hardware.width = 0.05  # on its way
    driven.send(EStop(True), "estop", PERSON)
    wait_until(lambda: hardware.written[-1] == (0.0, 0.05), "rest where it is", 5)


@pytest.mark.promise("P66")
def test_nothing_is_written_before_it_is_known_how_wide_a_gripper_is_also_after_a_fault(robot):  # noqa: F811
    hardware = Gripping()
    driven = robot(hardware, spec=SPEC)
    wait_until(lambda: hardware.calls["read"] > 5, "measurements", 5)
    assert hardware.written == []
    hardware.width = 0.08
    wait_until(lambda: hardware.written, "set-points", 5)
    hardware.width, hardware.raises = None, {"read"}
    wait_until(driven.is_in("stopped"), "stop", 5)
    hardware.raises, before = set(), hardware.calls["open"]
    wait_until(lambda: hardware.calls["open"] > before or not driven.node.driver.unready, "opened again", 5)
    written, reads = len(hardware.written), hardware.calls["read"]
    wait_until(lambda: hardware.calls["read"] > reads + 5, "measurements", 5)
    assert len(hardware.written) - written <= 1, "at most that of the last fault"
    hardware.width = 0.06
    wait_until(lambda: hardware.written[-1] == (0.0, 0.06), "the width of now", 5)


@pytest.mark.promise("P66")
def test_set_points_of_before_a_fault_move_no_gripper_that_people_have_moved_since(robot):  # noqa: F811
    """The loop was about to hand them on when the hardware was opened again, and the gripper went to its old width."""
    hardware = Gripping(0.08)
    driven = robot(hardware, spec=SPEC)
    wait_until(lambda: hardware.written, "set-points", 5)
    device, set_points, opened = driven.node.device, driven.node.driver.set_points, threading.Event()

    def slow(now_ns, kept):
        made = set_points(now_ns, kept)
        if hardware.width is None and kept is not None and not opened.is_set():
            hardware.raises = {"read"}
            wait_until(lambda: device.fault, "fault", 5)
            hardware.raises, first = set(), device.opening
            wait_until(lambda: device.opening > first and device.phase is Phase.RUNNING, "opened again", 5)
            opened.set()
        return made

    driven.node.driver.set_points = slow
    hardware.width = None
    assert opened.wait(10)
    written, reads = len(hardware.written), hardware.calls["read"]
    wait_until(lambda: hardware.calls["read"] > reads + 5, "measurements", 5)
    assert hardware.written[written:] == []


def test_a_robot_that_could_not_be_stopped_is_stopped_before_that_is_known(robot):  # noqa: F811
    hardware = Gripping(0.08)
    driven = robot(hardware, spec=SPEC)
    wait_until(lambda: not driven.node.driver.unready and hardware.written, "set-points", 5)
    driven.send(ArmRequest(True, False, EXECUTIVE, 0), "arm_request", PERSON)
    driven.send(VelocityCommand(0, 0.5, 0.1), "cmd_vel")
    wait_until(lambda: hardware.written[-1] == (0.5, 0.1), "motion", 5)
    hardware.width, hardware.raises = None, {"write"}
    wait_until(driven.is_in("stopped"), "stop", 5)
    wait_until(lambda: hardware.calls["close"], "closed", 5)
    assert hardware.taken[-1] == (0.5, 0.1)
    hardware.raises = set()
    wait_until(lambda: hardware.taken[-1][0] == 0.0, "standstill", 5)


@pytest.mark.parametrize(("kept", "fault"), [((0.0,), "kept returned"), ((0.0, math.nan), "kept returned")])
def test_set_points_that_are_none_are_a_fault(robot, kept, fault):  # noqa: F811
    hardware = Gripping(0.08)
    hardware.kept = lambda: kept
    driven = robot(hardware, spec=SPEC)
    wait_until(driven.is_in("stopped"), "stop", 5)
    assert f"read: ValueError: {fault}" in driven.state().detail


def test_hardware_without_the_method_keeps_its_last_set_point(robot):  # noqa: F811
    driven = robot(Faulty(), spec=replace(SPEC, limits=(SPEC.limits[0], Limit(0.0, 0.12, kept=0.07))))
    wait_until(lambda: len(driven.hardware.written) > 5, "set-points", 5)
    assert widths(driven.hardware) == {0.07}
