"""`tailor goal --cancel` drops the open goal of a system that `tailor up` started: moving, stopped, or done."""

import json
import subprocess
import time
from functools import partial

import pytest

from tailor.runtime.bus.opening import open_client
from tailor.runtime.processes.child import Child, tailor
from tailor.schemas.messages import DriverState, ExecStatus
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tests.support.bus_system import answers, free_endpoint
from tests.support.patience import PATIENCE_S, wait_until

QUIET_S = 2.0  # after arming a robot with an open goal moves within half a second


class System:
    """A launched robot as people at a shell see it."""

    def __init__(self, endpoint, session):
        self.endpoint, self.inbox = endpoint, session.inbox(("driver", "status", "truth"), "agilo")
        self.latest, self.fastest_mps = {}, 0.0

    def poll(self):
        for sample in self.inbox.drain():
            self.latest[type(sample.message)] = sample.message
            if isinstance(sample.message, SoccerGroundTruth):
                self.fastest_mps = max(self.fastest_mps, abs(sample.message.v), abs(sample.message.omega))
        return self.latest

    def moves(self):
        truth = self.poll().get(SoccerGroundTruth)
        return truth is not None and abs(truth.v) > 0.2

    def rests(self):
        truth = self.poll().get(SoccerGroundTruth)
        return truth is not None and abs(truth.v) < 0.01 and abs(truth.omega) < 0.01

    def mode(self):
        return self.poll()[DriverState].mode

    def tell(self, *words):
        """Run a command that people type; its output."""
        command = tailor(*words, "--connect", self.endpoint)
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S)
        assert done.returncode == 0, (words, done.stdout, done.stderr)
        return done.stdout.strip()

    def stays(self):
        wait_until(self.rests, "robot at rest")
        self.fastest_mps, ends = 0.0, time.monotonic() + QUIET_S
        while time.monotonic() < ends:
            self.poll()
            time.sleep(0.01)
        assert self.fastest_mps < 0.02
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
