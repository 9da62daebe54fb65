"""The node period by period, with a bus that is a list: what reaches the body, and when it is zero."""

import itertools
from collections import Counter

import pytest

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.encoding import encoding_of
from tailor.runtime.bus.inbox import Inbox, Raw
from tailor.schemas.codec import encode
from tailor.schemas.messages import ArmRequest, EStop, Sample, VelocityCommand
from tailor.schemas.topics import TOPICS, key_of
from tailor.simnodes.body import Reading
from tailor.simnodes.driver_spec import DriverSpec
from tailor.simnodes.guard import Limit, Mode
from tailor.simnodes.node import MAX_AT_ONCE, Node
from tailor.simnodes.services import MAX_STEPS
from tailor.simnodes.world import World
from tests.support.stand_ins.body import FakeBody
from tests.unit.simnodes.test_services import Request, Server

MS = 1_000_000
EXECUTIVE, PERSON = "a" * 32, "b" * 32
SPEC = DriverSpec("cmd_vel", ("v", "omega"), (Limit(-1.0, 1.0), Limit(-2.0, 2.0)))


class Body(FakeBody):
    """Notes each set-point."""

    def __init__(self):
        super().__init__()
        self.taken = []

    def command(self, values):
        self.taken.append(values[0])
        super().command(values)


class Bus:
    """Session, inbox and publishers in one."""

    def __init__(self):
        self.waiting, self.rejected, self.states = [], Counter(), []
        self.servers = {}

    def inbox(self, names, robot):
        return self

    def drain(self, now_ns):
        waiting, self.waiting = self.waiting, []
        return tuple(waiting)

    def service_server(self, key):
        return self.servers.setdefault(key.rpartition("/")[2], Server())

    def publisher(self, name, robot):
        return self if name == "driver" else Bus()

    def publish(self, message):
        self.states.append(message)


class Clock:
    def __init__(self):
        self.now = 0

    def now_ns(self):
        return self.now

    def sleep_until(self, deadline_ns):
        self.now = max(self.now, deadline_ns)


class Robot:
    """A node that runs as many periods as asked for."""

    def __init__(self):
        self.body, self.bus, self.clock = Body(), Bus(), Clock()
        self.node = Node(World(self.body, {}, 3), SPEC, self.bus, self.clock, epoch=7)
        self.numbers = itertools.count(1)

    def send(self, message, topic, sender):
        self.bus.waiting.append(Sample(f"agilo/{topic}", message, self.clock.now, next(self.numbers), sender))

    def periods(self, count):
        """Set-points that the body takes in the next periods."""
        before = len(self.body.taken)
        for _ in range(count):  # `run` would disarm the robot at its end
            self.node._run_period(self.node._loop.wait_for_next_period())
        return self.body.taken[before:]

    def moving(self):
        self.send(ArmRequest(True, False, EXECUTIVE, 0), "arm_request", PERSON)
        self.send(VelocityCommand(0, 0.5, 0.0), "cmd_vel", EXECUTIVE)
        assert self.periods(1) == [0.5]
        return self


def moving_robot():
    return Robot().moving()


def test_a_command_moves_the_body_in_the_period_of_its_arrival():
    robot = moving_robot()
    robot.send(VelocityCommand(0, 0.25, 0.0), "cmd_vel", EXECUTIVE)
    assert robot.periods(2) == [0.25, 0.25]


def test_the_body_stands_in_the_first_period_after_the_timeout():
    robot = moving_robot()
    assert robot.periods(32) == [0.5] * 30 + [0.0] * 2


def test_an_estop_stops_the_body_in_the_period_of_its_arrival():
    robot = moving_robot()
    robot.send(EStop(True), "estop", PERSON)
    assert robot.periods(1) == [0.0]
    assert robot.bus.states[-1].mode == "estopped"


def test_after_a_stall_the_body_catches_up_a_little_and_stands_meanwhile():
    robot = moving_robot()
    robot.clock.now += 5_000 * MS
    assert robot.periods(1) == [0.0] * MAX_AT_ONCE


def test_the_robot_is_disarmed_at_the_end_and_reports_it():
    robot = moving_robot()
    robot.node.run(lambda: True)
    assert robot.node.driver.guard.output(robot.clock.now) == (0.0, 0.0)
    state = robot.bus.states[-1]
    assert (state.mode, state.reason) == ("disarmed", "the driver ends")


def test_a_reset_of_the_world_disarms_the_robot():
    robot = Robot()
    robot.bus.servers["reset"].waiting.append(Request(""))
    robot.node.driver.guard.arm(0, EXECUTIVE)
    robot.periods(1)
    assert robot.node.driver.guard.mode is Mode.DISARMED


def test_a_paused_world_moves_in_requested_steps_alone_and_the_guard_waits_for_it():
    robot = moving_robot()
    robot.bus.servers["pause"].waiting.append(Request("true"))
    assert robot.periods(100) == []
    robot.bus.servers["step"].waiting.append(Request("5"))
    assert robot.periods(2) == [0.5] * 5
    robot.bus.servers["step"].waiting.append(Request("31"))
    assert robot.periods(5) == [0.5] * 25 + [0.0] * 6, "its guard counts the time of the world, also within a period"


@pytest.mark.promise("P38")
def test_an_estop_waits_for_few_of_many_requested_steps():
    robot = moving_robot()
    robot.bus.servers["pause"].waiting.append(Request("true"))
    robot.bus.servers["step"].waiting.append(Request(str(MAX_STEPS)))
    assert robot.periods(1) == [0.5] * MAX_AT_ONCE
    robot.send(EStop(True), "estop", PERSON)
    assert robot.periods(1) == [0.0] * MAX_AT_ONCE
    assert robot.bus.states[-1].mode == "estopped"
    assert len(robot.periods(1000)) == MAX_STEPS - 2 * MAX_AT_ONCE, "the others follow"


def test_a_dead_mans_switch_is_held_in_real_time_while_the_world_is_paused():
    robot = moving_robot()
    robot.send(EStop(False), "estop", PERSON)
    robot.bus.servers["pause"].waiting.append(Request("true"))
    robot.periods(52)
    assert robot.node.driver.guard.mode is Mode.ESTOPPED


class InterruptedBus(Bus):
    """A bus whose inbox is real; a reset, then an e-stop arrive before its look number `moment` at a subscription."""

    def __init__(self, moment):
        super().__init__()
        self.queues, self.looks, self.moment = {}, 0, moment

    def inbox(self, names, robot):
        self.queues = {name: [] for name in names}
        rows = [(TOPICS[name], key_of(name, robot), _Look(self, name)) for name in names]
        return Inbox(rows, now=lambda: 0, wall=lambda: 0)

    def look(self, name):
        if self.looks == self.moment:
            self.queues["arm_request"].append(ArmRequest(True, True, EXECUTIVE, 0))
            self.queues["estop"].append(EStop(True))
        self.looks += 1
        return self.queues[name].pop(0) if self.queues[name] else None


class _Look:
    def __init__(self, bus, name):
        self.bus, self.name = bus, name

    def receive(self):
        message = self.bus.look(self.name)
        if message is None:
            return None
        origin = pack(Origin(self.bus.looks, 1, PERSON))
        return Raw(key_of(self.name, "agilo"), encode(message), origin, encoding_of(type(message)), True, None)


@pytest.mark.promise("P38")
def test_an_estop_that_follows_a_reset_wins_at_whatever_moment_of_a_period_both_arrive():
    for moment in range(20):
        bus = InterruptedBus(moment)
        node = Node(World(Body(), {}, 3), SPEC, bus, Clock(), epoch=7)
        while bus.looks <= moment:
            node._run_period(node._loop.wait_for_next_period())
        node._run_period(node._loop.wait_for_next_period())
        assert node.driver.guard.mode is Mode.ESTOPPED, f"both arrived before look {moment}"


def test_a_reading_of_a_type_without_stamps_is_published(monkeypatch):
    """The simulator ended with a TypeError."""
    robot = Robot()
    published = robot.bus.publisher("estop", "")
    monkeypatch.setattr(robot.node, "_publisher", lambda topic: published)
    monkeypatch.setattr(robot.body, "advance", lambda duration_ns: [Reading("estop", EStop(False), 0)])
    robot.periods(2)
    assert published.states == [EStop(False)] * 2
