"""A dropped goal of a system that `tailor up` started is not pursued: moving, stopped, done, or by a new executive."""

import json
import os
import signal
import subprocess
from functools import partial

import pytest

from tailor.runtime.bus.opening import open_client
from tailor.runtime.processes.child import Child, tailor
from tailor.schemas.messages import DriverState, ExecStatus
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tests.support.bus_system import answers, child_pid, free_endpoint
from tests.support.patience import PATIENCE_S, wait_until
from tests.support.watched_robot import QUIET_S, WatchedRobot


class System(WatchedRobot):
    """A launched robot as people at a shell see it."""

    def __init__(self, endpoint, session, up):
        super().__init__(session)
        self.endpoint, self.up = endpoint, up

    def moves(self):
        truth = self.poll().get(SoccerGroundTruth)
        return truth is not None and abs(truth.v) > 0.2

    def mode(self):
        return self.poll()[DriverState].mode

    def tell(self, *words):
        """Run a command that people type; its output."""
        command = tailor(*words, "--connect", self.endpoint)
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S)
        assert done.returncode == 0, (words, done.stdout, done.stderr)
        return done.stdout.strip()

    def stays(self):
        wait_until(self.at_rest, "robot at rest")
        assert self.fastest_in(QUIET_S) < 0.02
        assert self.mode() == "armed"

    def restart_executive(self):
        sender = self.poll()[ExecStatus].sender
        os.kill(child_pid(self.up.pid, "executive"), signal.SIGKILL)
        wait_until(lambda: self.poll()[ExecStatus].sender != sender, "another executive")


@pytest.fixture(scope="module")
def launched():
    """One system for all tests: after each, a goal is open and the robot moves, as after its start."""
    endpoint = free_endpoint()
    up = Child("up", tailor("up", "soccer", "--scenario", "waypoints", "--connect", endpoint), subprocess.DEVNULL)
    try:
        wait_until(partial(answers, endpoint), "router")
        with open_client(endpoint) as session:
            yield System(endpoint, session, up)
    finally:
        up.stop()


@pytest.fixture
def system(launched):
    """It pursues a goal: at first its own, later the one that the last test has set, or another one if that is done."""
    started = ExecStatus in launched.poll()
    if started and launched.latest[ExecStatus].result:
        launched.tell("goal")
    wait_until(launched.moves, "robot moves")
    return launched


@pytest.mark.promise("P41")
@pytest.mark.xdist_group("systems")
@pytest.mark.parametrize(
    "told", [(), ("goal", "--cancel"), ("goal", "(visited way3)")], ids=["own", "dropped", "other"]
)
def test_an_executive_that_is_started_again_has_no_goal(system, told):
    """The first one was started with a goal of its own."""
    if told:
        system.tell(*told)
    system.restart_executive()
    wait_until(system.at_rest, "robot at rest")
    system.tell("arm", "agilo")
    system.stays()
    status = system.latest[ExecStatus]
    assert (status.mode, status.goal, status.result) == ("READY", "", "")
    system.tell("goal")
    wait_until(system.moves, "robot moves: a goal was set")


@pytest.mark.promise("P41")
@pytest.mark.xdist_group("systems")
def test_a_cancelled_goal_brakes_the_robot_and_is_not_pursued_when_people_arm_it_after_an_estop(system):
    goal = system.latest[ExecStatus].goal
    assert system.tell("goal", "--cancel") == f"cancelled: {goal}"
    system.stays()
    status = system.latest[ExecStatus]
    assert (status.mode, status.goal, status.result) == ("READY", goal, "cancelled")
    assert json.loads(system.tell("goal", "--cancel", "--json")) == {"accepted": True, "answer": "no goal is open"}
    system.tell("goal")
    wait_until(system.moves, "robot moves: another goal was set")
    system.tell("estop")
    assert system.mode() == "estopped"
    assert system.tell("goal", "--cancel") == f"cancelled: {goal}"
    system.tell("arm", "agilo", "--reset")
    system.stays()
    system.tell("goal")
    wait_until(system.moves, "robot moves: another goal was set")
