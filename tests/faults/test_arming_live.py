"""Nobody is moved unasked: after a restart of either side, or an operator's disarm, only people arm again."""

import os
import random
import signal
import subprocess
import time

import pytest

from tailor.runtime.bus.opening import open_client
from tailor.runtime.processes.child import Child, tailor
from tailor.schemas.messages import ArmRequest, DriverState, ExecStatus
from tests.support.bus_system import answers, child_pid, free_endpoint
from tests.support.patience import wait_until
from tests.support.watched_robot import QUIET_S, WatchedRobot

MOVING_MPS = 0.2


class Launched(WatchedRobot):
    """A system that `tailor up` started, as another session on the bus sees it."""

    def __init__(self, up, session):
        super().__init__(session)
        self.up, self.session = up, session
        self.outlet = session.publisher("arm_request", "agilo")

    def moves(self):
        self.fastest_mps = 0.0
        self.poll()
        return self.fastest_mps > MOVING_MPS

    def arm(self, arm=True):
        self.outlet.publish(ArmRequest(arm, False, self.latest[ExecStatus].sender if arm else "", 0))

    def kill(self, *names):
        for name in names:
            os.kill(child_pid(self.up.pid, name), signal.SIGKILL)

    def changed(self, kind, field, before):
        return lambda: getattr(self.poll().get(kind), field, before) != before


@pytest.fixture
def launched():
    endpoint = free_endpoint()
    words = tailor("up", "soccer", "--scenario", "waypoints", "--connect", endpoint)
    up = Child("up", words, subprocess.DEVNULL)
    try:
        wait_until(lambda: answers(endpoint), "router")
        with open_client(endpoint, role="people") as session:
            system = Launched(up, session)
            wait_until(system.moves, "the launched robot moves: its executive has leave")
            yield system
    finally:
        up.stop()


def restarted(system, *names):
    """Kill children and wait until their successors are heard."""
    sender, epoch = system.poll()[ExecStatus].sender, system.latest[DriverState].epoch
    system.kill(*names)
    if "sim" in names:
        wait_until(system.changed(DriverState, "epoch", epoch), "another driver")
    if "executive" in names:
        wait_until(system.changed(ExecStatus, "sender", sender), "another executive")


def disarmed(system):
    system.arm(False)
    wait_until(lambda: system.poll()[DriverState].mode == "disarmed", "disarmed")


WAYS = {
    "disarmed": disarmed,
    "disarmed, then the executive restarts": lambda system: (disarmed(system), restarted(system, "executive")),
    "the executive restarts": lambda system: restarted(system, "executive"),
    "the driver restarts": lambda system: restarted(system, "sim"),
    "both restart": lambda system: restarted(system, "sim", "executive"),
}


@pytest.mark.promise("P41")
@pytest.mark.xdist_group("systems")
@pytest.mark.parametrize("number", [0, *(pytest.param(n, marks=pytest.mark.slow) for n in range(1, 20))])
def test_only_people_arm_again(launched, number):
    """After each way, in one system, in random order: people arm the robot in between."""
    phases = random.Random(number)
    for way in phases.sample(list(WAYS), len(WAYS)):  # no child is started five times, as often as a launcher allows
        time.sleep(phases.uniform(0.0, 0.3))
        WAYS[way](launched)
        stays_until_people_arm_it(launched, way)


def stays_until_people_arm_it(launched, way):
    wait_until(launched.at_rest, "robot at rest")
    assert launched.fastest_in(QUIET_S) < 0.02, way
    assert launched.latest[DriverState].mode != "armed", way
    wait_until(lambda: ExecStatus in launched.poll(), "executive")
    launched.arm()
    if not launched.latest[ExecStatus].goal:  # this executive was started again
        assert launched.fastest_in(QUIET_S) < 0.02, way
        assert launched.session.call("exec/goal", "") == (True, "accepted")
    wait_until(launched.moves, "the robot moves when people arm it, and set a goal where there is none")
