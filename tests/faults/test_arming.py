"""Nothing moves unless people armed last, or the launcher at the start of this run, and nothing revoked it since."""

import itertools

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

from tailor.schemas.messages import ArmRequest, EStop, Sample, VelocityCommand
from tailor.simnodes.driver import Driver
from tailor.simnodes.driver_spec import DriverSpec
from tailor.simnodes.guard import Limit

SPEC = DriverSpec("cmd_vel", ("v", "omega"), (Limit(-1.0, 1.0), Limit(-2.0, 2.0)))
PERSON, HOLDER = "f" * 32, "e" * 32
MS = 1_000_000


class Robot(RuleBasedStateMachine):
    """A driver and an executive that are killed and restarted; the executive asks to be armed whenever it can.

    `armed_for` is the model: the sender that may move the robot, as a person would keep account of it.
    """

    def __init__(self) -> None:
        super().__init__()
        self.now_ns = 0
        self.numbers = itertools.count(1)
        self.epochs = itertools.count(1)
        self.senders = (f"{n:032x}" for n in itertools.count(1))
        self.executive = next(self.senders)
        self.leave = self.executive  # whoever the launcher named for this start of the run, until it is revoked
        self.driver = Driver(SPEC, next(self.epochs), leave=self.executive)
        self.armed_for = ""
        self.latched = False
        self.moved = False
        self.held_ns: int | None = None  # newest message of the dead man's switch

    def wait(self, duration_ns: int) -> None:
        self.now_ns += duration_ns
        self.driver.take([], {}, self.now_ns)
        if self.held_ns is not None and self.now_ns - self.held_ns > 500 * MS:
            self.armed_for, self.leave, self.latched, self.held_ns = "", "", True, None

    def send(self, *messages, by="") -> None:
        by = by or self.executive
        key = "agilo/arm_request" if by == PERSON else "agilo/self_arm"
        samples = [Sample(key, message, self.now_ns, next(self.numbers), by) for message in messages]
        self.driver.take(samples, {}, self.now_ns)

    @rule(named=st.booleans(), reset=st.booleans())
    def executive_asks(self, named: bool, reset: bool) -> None:
        """It may ask in any form, with a reset too."""
        self.send(ArmRequest(True, reset, self.executive if named else "", 0))
        if self.leave == self.executive and not self.armed_for:
            self.armed_for, self.leave = self.executive, ""

    @rule()
    def executive_drives(self) -> None:
        self.send(VelocityCommand(0, 0.5, 0.0))
        self.moved |= self.driver.guard.output(self.now_ns) != (0.0, 0.0)

    @rule(reset=st.booleans())
    def people_arm(self, reset: bool) -> None:
        self.send(ArmRequest(True, reset, self.executive, 0), by=PERSON)
        if not self.armed_for and (reset or not self.latched):
            self.held_ns = None if self.latched else self.held_ns
            self.armed_for, self.leave, self.latched = self.executive, "", False

    @rule()
    def people_disarm(self) -> None:
        self.send(ArmRequest(False, False, "", 0), by=PERSON)
        self.armed_for, self.leave = "", ""

    @rule(order=st.permutations(["stop", "arm", "reset", "drive"]))
    def people_stop(self, order: list[str]) -> None:
        """An e-stop wins over every arming of the same moment, whatever their order."""
        messages = {
            "stop": (EStop(True), PERSON),
            "arm": (ArmRequest(True, False, self.executive, 0), self.executive),
            "reset": (ArmRequest(True, True, self.executive, 0), PERSON),
            "drive": (VelocityCommand(0, 0.5, 0.0), self.executive),
        }
        numbered = [(messages[name], next(self.numbers)) for name in order]
        samples = [Sample("", message, self.now_ns, number, by) for (message, by), number in numbered]
        self.driver.take(samples, {}, self.now_ns)
        self.armed_for, self.leave, self.latched = "", "", True

    @rule()
    def motor_fails(self) -> None:
        self.driver.guard.stop("motor failed")
        self.armed_for, self.leave = "", ""

    @rule()
    def people_hold_a_switch(self) -> None:
        self.send(EStop(False), by=HOLDER)
        self.held_ns = self.now_ns

    @rule()
    def time_passes(self) -> None:
        """So little that a command holds on, but twice as much is a release of the switch."""
        self.wait(260 * MS)
        self.executive_drives()

    @rule()
    def commands_cease(self) -> None:
        self.wait(400 * MS)
        if self.armed_for:
            self.armed_for = ""

    @rule()
    def executive_restarts(self) -> None:
        """The supervisor starts it anew: under another name, without leave."""
        self.executive = next(self.senders)

    @rule()
    def driver_restarts(self) -> None:
        """The supervisor starts it anew, without leave."""
        self.driver = Driver(SPEC, next(self.epochs))
        self.armed_for, self.leave, self.latched, self.held_ns = "", "", False, None

    @invariant()
    def nobody_moves_it_unasked(self) -> None:
        moving = self.driver.guard.output(self.now_ns) != (0.0, 0.0)
        assert not (moving and not self.armed_for)
        assert self.driver.guard.sender in ("", self.armed_for)


Robot.TestCase.settings = settings(max_examples=300, stateful_step_count=30, deadline=None)
TestNobodyIsMovedUnasked = pytest.mark.promise("P41")(Robot.TestCase)


def test_the_machine_does_move_the_robot() -> None:
    """Else the invariant would hold of a robot that never moves."""
    robot = Robot()
    robot.executive_asks(True, False)
    robot.executive_drives()
    assert robot.moved
