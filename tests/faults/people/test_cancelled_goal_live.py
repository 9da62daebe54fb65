"""`tailor goal --cancel` drops the open goal of a system that `tailor up` started: moving, stopped, or done."""

import json
import subprocess
from functools import partial

import pytest

from tailor.runtime.bus.opening import open_client
from tailor.runtime.processes.child import Child, tailor
from tailor.schemas.messages import DriverState, ExecStatus
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tests.support.bus_system import answers, free_endpoint
from tests.support.patience import PATIENCE_S, wait_until
from tests.support.watched_robot import QUIET_S, WatchedRobot


class System(WatchedRobot):
    """A launched robot as people at a shell see it."""

    def __init__(self, endpoint, session):
        super().__init__(session)
        self.endpoint = endpoint

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


@pytest.mark.promise("P41")
@pytest.mark.xdist_group("live")
def test_a_cancelled_goal_brakes_the_robot_and_is_not_pursued_when_people_arm_it_after_an_estop():
    endpoint = free_endpoint()
    up = Child("up", tailor("up", "soccer", "--scenario", "waypoints", "--connect", endpoint), subprocess.DEVNULL)
    try:
        wait_until(partial(answers, endpoint), "router")
        with open_client(endpoint) as session:
            system = System(endpoint, session)
            wait_until(system.moves, "robot moves")
            goal = system.latest[ExecStatus].goal
            assert system.tell("goal", "--cancel") == f"cancelled: {goal}"
            system.stays()
            status = system.latest[ExecStatus]
            assert (status.mode, status.goal, status.result) == ("READY", goal, "cancelled")
            assert json.loads(system.tell("goal", "--cancel", "--json")) == {
                "accepted": True,
                "answer": "no goal is open",
            }
            system.tell("goal")
            wait_until(system.moves, "robot moves: another goal was set")
            system.tell("estop")
            assert system.mode() == "estopped"
            assert system.tell("goal", "--cancel") == f"cancelled: {goal}"
            system.tell("arm", "agilo", "--reset")
            system.stays()
            system.tell("goal")
            wait_until(system.moves, "robot moves: another goal was set")
    finally:
        up.stop()
