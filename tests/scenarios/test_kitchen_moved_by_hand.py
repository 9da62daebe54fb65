"""The B21 whose gripper people open or close by hand while nobody may move it: arming it again moves nothing."""

from __future__ import annotations

import pytest

from tailor.executive import domains
from tailor.executive.core.state import Inputs, initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import PERIOD_NS, Settings, make_context
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.schemas.messages import ArmRequest, EStop, Sample
from tailor.simnodes.b21.profiles import PROFILES
from tailor.simnodes.world import World
from tailor.tools.lockstep.bodies import body_of
from tailor.tools.lockstep.driver_link import DriverLink
from tailor.tools.lockstep.run import SENDER

PERSON = "bb" * 16
STOPS = {"disarmed": ("arm_request", ArmRequest(False, False, "", 0)), "stopped": ("estop", EStop(True))}
STOPPED, MOVED, RELEASED, END = 15, 20, 30, 60  # periods


class System:
    """Executive, driver and body in lock-step, without a goal: nothing asks the robot to move."""

    def __init__(self, profile, **start):
        scenario, drawn = domains.seeded_scenario("kitchen", "one-cup", 3)
        self.context = make_context(domains.load("kitchen"), scenario, Models({}, {}), Settings(), SENDER)
        self.world = World(body_of("kitchen", profile), {**drawn, **start}, 3, ())
        self.link, self.state, self.period = DriverLink(self.context.domain, self.world, SENDER), None, 0
        self.samples, _ = self.link.advance(0)
        self.state = initial_state(self.context)

    def people(self, topic, message):
        now_ns = self.period * PERIOD_NS
        self.link._driver.take([Sample(f"b21/{topic}", message, now_ns, self.period, PERSON)], {}, now_ns)

    def arm(self):
        self.people("arm_request", ArmRequest(True, True, SENDER, 0))

    def until(self, period):
        """Widths of the gripper in the periods up to this one, m."""
        widths = []
        while self.period < period:
            self.period += 1
            now_ns = self.period * PERIOD_NS
            self.state, outputs = step(self.context, self.state, now_ns, Inputs(self.samples), CheckBudget(1))
            self.link.send(outputs, now_ns, self.period)
            self.samples, _ = self.link.advance(now_ns)
            widths.append(self.world.body.ground_truth().width)
        return widths

    @property
    def armed(self):
        return self.link._driver.guard.mode == "armed"


@pytest.mark.promise("P41")
@pytest.mark.parametrize("stop", STOPS.values(), ids=STOPS)
@pytest.mark.parametrize("width", [0.03, 0.12])
@pytest.mark.parametrize("profile", PROFILES)
def test_a_gripper_that_people_have_moved_stays_where_it_is_when_they_arm_the_robot(stop, width, profile, measured):
    robot = System(profile, width=0.08)
    robot.until(5)
    robot.arm()
    widths = robot.until(STOPPED)
    assert robot.armed
    measured.add(max(abs(each - 0.08) for each in widths), limit=0.003, unit="m")
    robot.people(*stop)
    robot.until(MOVED)
    robot.world.body.place({"width": width})
    robot.until(RELEASED)
    robot.arm()
    widths = robot.until(END)
    assert robot.armed
    measured.add(max(abs(each - width) for each in widths), limit=0.003, unit="m")


@pytest.mark.parametrize("profile", PROFILES)
def test_a_cup_in_the_gripper_is_still_held_after_a_stop_and_arming(profile):
    robot = System(profile, held=1.0)
    for begin in (5, 30):
        robot.until(begin)
        robot.arm()
        robot.until(begin + 10)
        assert robot.armed
        robot.people(*STOPS["stopped"])
    robot.until(END)
    assert robot.world.body.ground_truth().held == "cup1"
