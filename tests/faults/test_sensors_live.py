"""Sensors that freeze, slow down or are cut off: what the real executive does, at the guard's output."""

import json
import random
import time
from contextlib import ExitStack, contextmanager

import pytest

from tailor.schemas.messages import ArmRequest, ExecStatus
from tests.support.bus_system import bus_system, outputs
from tests.support.injection.tcp_proxy import tcp_proxy
from tests.support.patience import wait_until
from tests.support.stalls import repeat_on_stall

STALE_S = 0.5
TICK_S = 0.1
HOLD_S = STALE_S + TICK_S + 0.05  # the tick that notices, and the way to the guard
SILENT_S = HOLD_S + 0.3 + TICK_S  # an executive that hears no driver sends nothing; then the guard's time-out counts
TRIES = [1, pytest.param(20, marks=pytest.mark.slow)]


class Robot:
    """The stand-in robot with faulty sensors, driven by `tailor executive` from waypoint to waypoint."""

    def __init__(self, session, endpoint, start, folder, proxy):
        self.trace, self.rates, self.proxy = folder / "trace", folder / "rates", proxy
        self.statuses = session.inbox(["status"], "agilo")
        self.arming = session.publisher("arm_request", "agilo")
        self.status, self.seed = None, 0
        self._start, self._children = start, []
        start("tests.support.stand_ins.faulty_sim", endpoint, self.trace, self.rates)

    def sensors(self, **rates_hz):
        """Limits the rates of the named topics and no others."""
        new = self.rates.with_suffix(".new")
        new.write_text(json.dumps(rates_hz))
        new.replace(self.rates)

    def starts(self):
        """A new executive with another start, which people arm; the robot moves by now."""
        for child in self._children:
            child.kill()
        self.sensors()
        self.seed += 1
        arguments = ("--scenario", "waypoints", "--seed", self.seed, "--connect", self.proxy.endpoint)
        self._children = [self._start("tailor.tools.main", "executive", "soccer", *arguments)]
        self.status = None
        wait_until(self.asks_to_be_armed, "executive")
        wait_until(self.moves, "robot moves")

    def asks_to_be_armed(self):
        """Whether the new executive is there and not armed yet; people arm it then."""
        self.poll()
        if self.status is None or not self.status.reason.startswith("driver not armed"):
            return False
        self.arming.publish(ArmRequest(True, False, self.status.sender, 0))
        return True

    def poll(self):
        for sample in self.statuses.drain():
            if isinstance(sample.message, ExecStatus):
                self.status = sample.message
        return self.status

    def moves(self):
        return self.poll() and self.status.mode == "EXECUTING" and outputs(self.trace)[-1][1] > 0.2

    def stands(self, reason):
        return lambda: self.poll() and self.status.reason == reason and outputs(self.trace)[-1][1] == 0.0

    def stopped_s(self, since_s):
        return wait_until(
            lambda: next((at for at, v in outputs(self.trace) if at > since_s and v == 0.0), None), "zero"
        )


@contextmanager
def robot_in(folder):
    with ExitStack() as stack:
        session, endpoint, start = stack.enter_context(bus_system())
        yield Robot(session, endpoint, start, folder, stack.enter_context(tcp_proxy(endpoint)))


@pytest.mark.promise("P6")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("tries", TRIES)
def test_a_frozen_sensor_stops_the_robot_and_motion_goes_on_with_it(tmp_path, tries, measured):
    phases = random.Random(5)
    with robot_in(tmp_path) as robot:

        def frozen():
            robot.starts()
            time.sleep(phases.uniform(0.0, 0.1))
            since_s = time.monotonic()
            robot.sensors(odom=0)
            stop_s = robot.stopped_s(since_s) - since_s
            wait_until(robot.stands("input stale"), "hold")
            robot.sensors()
            wait_until(robot.moves, "motion goes on, without being armed again")
            assert stop_s > 0.3, "a pause of the sensor that is no fault must not stop the robot"
            assert stop_s <= HOLD_S
            return stop_s

        for _ in range(tries):
            measured.add(repeat_on_stall(3, frozen), HOLD_S, what="to zero")


@pytest.mark.promise("P21")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("tries", [1, pytest.param(5, marks=pytest.mark.slow)])
def test_at_half_its_rate_a_sensor_starts_no_other_action(tmp_path, tries, measured):
    with robot_in(tmp_path) as robot:

        def halved():
            robot.starts()
            assert robot.status.action_index == 0
            robot.sensors(odom=25)
            wait_until(robot.stands("input slow"), "hold")
            assert (robot.status.mode, robot.status.action, robot.status.action_index) == ("HOLDING", "", 1)
            since_s = time.monotonic()
            time.sleep(2.0)
            started = [v for at, v in outputs(robot.trace) if at > since_s and v != 0.0]
            robot.sensors()
            wait_until(robot.moves, "motion goes on")
            assert robot.status.action_index == 1
            return len(started)

        for _ in range(tries):
            measured.add(repeat_on_stall(3, halved), 0, unit="set-points", what="while it stands")


@pytest.mark.promise("P12")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("tries", TRIES)
def test_an_executive_that_hears_nothing_stops_the_robot(tmp_path, tries, measured):
    """One-way partition: its commands arrive, but no sensor and no driver state reach it."""
    phases = random.Random(6)
    with robot_in(tmp_path) as robot:

        def deaf():
            robot.proxy.block(False)
            robot.starts()
            time.sleep(phases.uniform(0.0, 0.1))
            since_s = time.monotonic()
            robot.proxy.block(to_router=False)
            stop_s = robot.stopped_s(since_s) - since_s
            assert stop_s <= SILENT_S
            return stop_s

        for _ in range(tries):
            measured.add(repeat_on_stall(3, deaf), SILENT_S, what="to zero")
