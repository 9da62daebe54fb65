"""A gripper whose driver stops: it stays where it is, and goes on holding what it holds."""

import pytest

from tailor.schemas.kitchen.furniture import kitchen
from tailor.schemas.kitchen.kinematics import JOINTS
from tailor.schemas.messages import ArmRequest, EStop, JointCommand, Sample, VelocityCommand
from tailor.schemas.messages.kitchen import GripperCommand
from tailor.simnodes.b21.profiles import body as of_profile
from tailor.simnodes.driver import Driver
from tailor.simnodes.driver_spec import shipped_driver_spec
from tailor.simnodes.guard import TIMEOUT_NS, Mode
from tailor.simnodes.world import World
from tests.support.kitchen.b21_moves import OPEN_M, SHUT_M

SENDER, PERSON = "a" * 32, "b" * 32
PERIOD_NS = 10_000_000
CUP_M = 2 * kitchen().cup.radius


class Robot:
    """A driver with the body behind it, in periods of 10 ms."""

    def __init__(self, **start):
        self.world = World(of_profile(), start, 3)
        self.driver = Driver(shipped_driver_spec("b21"), 7)
        self.now_ns, self.sequence = 0, 0

    def send(self, key, message, sender=PERSON):
        self.sequence += 1
        self.driver.take([Sample(f"b21/{key}", message, self.now_ns, self.sequence, sender)], {}, self.now_ns)

    def periods(self, count, width=None):
        """Run, with commands for the gripper or without any; its width at the end, m."""
        for _ in range(count):
            if width is not None:
                self.sequence += 1
                for key, message in (
                    ("cmd_vel", VelocityCommand(0, 0.0, 0.0)),
                    ("joint_cmd", JointCommand(0, JOINTS, (0.0,) * 6)),
                    ("gripper_cmd", GripperCommand(0, width)),
                ):
                    sample = Sample(f"b21/{key}", message, self.now_ns, self.sequence, SENDER)
                    self.driver.take([sample], {}, self.now_ns)
            self.world.body.command(self.driver.set_points(self.now_ns, self.world.kept))
            self.world.advance(PERIOD_NS)
            self.now_ns += PERIOD_NS
        return self.world.body.ground_truth().width

    def armed(self):
        self.send("arm_request", ArmRequest(True, False, SENDER, 0))
        return self


@pytest.mark.promise("P38")
@pytest.mark.parametrize(("start", "target"), [(0.12, SHUT_M), (0.0, OPEN_M)])
def test_an_estop_stops_a_gripper_where_it_is(start, target, measured):
    robot = Robot(width=start).armed()
    before = robot.periods(50, width=target)
    assert abs(before - start) > 0.04, "it moved"
    robot.send("estop", EStop(True))
    measured.add(abs(robot.periods(150) - before), limit=0.003, unit="m")
    assert robot.driver.guard.mode is Mode.ESTOPPED


def test_a_time_out_stops_it_too():
    robot = Robot(width=0.12).armed()
    robot.periods(30, width=SHUT_M)
    at_timeout = robot.periods(TIMEOUT_NS // PERIOD_NS + 1)
    assert robot.periods(150) == pytest.approx(at_timeout, abs=0.003)
    assert robot.driver.guard.mode is Mode.STOPPED


@pytest.mark.promise("P38")
def test_an_estop_drops_no_cup():
    robot = Robot(held=1.0).armed()
    robot.periods(60, width=SHUT_M)
    robot.send("estop", EStop(True))
    assert robot.periods(300) == pytest.approx(CUP_M, abs=0.002)
    assert robot.world.body.ground_truth().held == "cup1"


def test_nothing_moves_before_anybody_has_armed_it():
    assert Robot(width=0.08).periods(150) == pytest.approx(0.08, abs=0.001)
