"""The example driver runs a robot on the bus: an unmodified executive drives it to its goal."""

import time
from functools import partial

import pytest

from tailor.schemas.messages import ArmRequest, VelocityCommand
from tests.support.bus_system import ROOT, bus_system
from tests.support.patience import wait_until
from tests.support.robots.driving import achieved, arm, executive_on, newest, ready

EXAMPLE = ROOT / "examples" / "rover_driver.py"


@pytest.fixture
def system():
    with bus_system() as (session, endpoint, start):
        start("tailor.tools.main", "driver", f"{EXAMPLE}:Rover", "--connect", endpoint)
        yield session, endpoint, start


def test_the_example_is_short():
    assert len(EXAMPLE.read_text().splitlines()) <= 60


def test_a_person_arms_the_rover_and_it_moves_as_commanded(system):
    session, _, _ = system
    states, odometry = session.inbox(["driver"], "agilo"), session.inbox(["odom"], "agilo")
    commands, arming = session.publisher("cmd_vel", "agilo"), session.publisher("arm_request", "agilo")
    ready(session, "agilo")

    def moved():
        arming.publish(ArmRequest(True, False, session.sender, 0))
        commands.publish(VelocityCommand(time.time_ns(), 0.2, 0.0))
        time.sleep(0.05)
        return newest(odometry, lambda m: m.x > 0.1 and 0.15 < m.v < 0.25)

    wait_until(moved, "motion")
    stopped = wait_until(partial(newest, states, lambda m: m.mode == "stopped"), "stop")
    assert stopped.reason == "no valid command in time"
    wait_until(partial(newest, odometry, lambda m: m.v == 0.0), "rest")


@pytest.mark.slow
def test_an_executive_drives_the_rover_through_its_waypoints(system):
    session, endpoint, start = system
    ready(session, "agilo")
    executive = executive_on(start, endpoint, "soccer", "waypoints")
    arm(session, "agilo")
    assert achieved(executive)
