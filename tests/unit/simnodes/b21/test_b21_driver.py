"""Base, arm and gripper behind one guard, as driver.toml declares them."""

import pytest

from tailor.schemas.kitchen.kinematics import GRIPPER_MAX_M, JOINT_MAX_RADPS, JOINTS, OMEGA_MAX_RADPS, V_MAX_MPS
from tailor.schemas.messages import ArmRequest, JointCommand, Sample, VelocityCommand
from tailor.schemas.messages.kitchen import GripperCommand
from tailor.simnodes.driver import Driver
from tailor.simnodes.driver_spec import shipped_driver_spec
from tailor.simnodes.guard import TIMEOUT_NS, Mode, Reason

SPEC = shipped_driver_spec("b21")
SENDER = "a" * 32
RATES = (0.1, -0.2, 0.3, 0.0, 0.5, -0.6)
MOVING = (0.4, -0.5, *RATES, 0.06)
AT_REST_HOLDING = (0.0,) * 8 + (0.06,)


def command(sequence, at_ns=0, rates=RATES, width=0.06, v=0.4):
    parts = (
        ("cmd_vel", VelocityCommand(0, v, -0.5)),
        ("joint_cmd", JointCommand(0, JOINTS, rates)),
        ("gripper_cmd", GripperCommand(0, width)),
    )
    return [Sample(f"b21/{topic}", message, at_ns, sequence, SENDER) for topic, message in parts]


def moving():
    driver = Driver(SPEC, 7, leave=SENDER)
    driver.take([Sample("b21/self_arm", ArmRequest(True, False, "", 0), 0, 1, SENDER)], {}, 0)
    driver.take(command(1), {}, 0)
    assert driver.guard.output(0) == MOVING
    return driver


def test_limits_are_those_of_the_robot():
    limits = [(limit.lower, limit.upper) for limit in SPEC.limits]
    assert SPEC.axes == ("v", "omega", *JOINTS, "width")
    assert limits[:2] == [(-V_MAX_MPS, V_MAX_MPS), (-OMEGA_MAX_RADPS, OMEGA_MAX_RADPS)]
    assert limits[2:8] == [(-JOINT_MAX_RADPS, JOINT_MAX_RADPS)] * 6
    assert limits[8] == (0.0, GRIPPER_MAX_M)


def test_a_time_out_stops_base_and_arm_and_drops_no_cup():
    driver = moving()
    driver.take([], {}, TIMEOUT_NS + 1)
    assert driver.guard.output(TIMEOUT_NS + 1) == AT_REST_HOLDING
    assert (driver.guard.mode, driver.guard.reason) == (Mode.STOPPED, Reason.COMMAND_TIMEOUT)


@pytest.mark.parametrize("missing", [0, 1, 2])
def test_a_command_that_lacks_one_outlet_moves_nothing_and_soon_stops_all(missing):
    driver, now_ns = moving(), 0
    for sequence in range(2, 8):
        now_ns = sequence * TIMEOUT_NS // 4
        parts = command(sequence, now_ns, rates=(0.0,) * 6, width=0.1, v=0.1)
        driver.take([part for number, part in enumerate(parts) if number != missing], {}, now_ns)
        assert driver.guard.output(now_ns) in (MOVING, AT_REST_HOLDING)
    assert driver.guard.output(now_ns) == AT_REST_HOLDING


def test_one_joint_beyond_its_limit_keeps_base_and_gripper_from_moving():
    driver = moving()
    driver.take(command(2, 10, rates=(*RATES[:5], 1.3), width=0.1, v=0.1), {}, 10)
    assert driver.guard.output(10) == MOVING


def test_an_unarmed_robot_keeps_its_gripper_closed_on_what_it_holds():
    assert Driver(SPEC, 7).guard.output(0) == (0.0,) * 9
