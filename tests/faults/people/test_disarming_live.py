"""`tailor arm` and `tailor arm --off` on busy machines: confirmed by the driver, or reported as not."""

import os
import random
import signal
import subprocess
import time
from functools import partial

import pytest

from tailor.runtime.bus.opening import open_client
from tailor.runtime.processes.child import Child, tailor
from tailor.runtime.stopping import SIGNALS
from tailor.schemas.messages import ArmRequest, DriverState
from tailor.simnodes.driver import Driver
from tailor.simnodes.driver_spec import DriverSpec
from tailor.simnodes.guard import Limit
from tests.support.bus_system import answers, bus_system, child_pid, free_endpoint, guarded_robot, secured_system
from tests.support.driven import Driven, burners
from tests.support.injection.signals import heeded_signals
from tests.support.patience import PATIENCE_S, wait_until

pytestmark = pytest.mark.xdist_group("live")
KILLS = 3  # of one executive: the launcher gives up a child that it starts five times in a minute
SLOW = pytest.mark.slow


def arm(endpoint, *flags):
    words = tailor("arm", "agilo", *flags, "--connect", endpoint)
    return subprocess.run(words, capture_output=True, text=True, timeout=PATIENCE_S)


def disarmed(robot):
    """Disarm a robot that moves: the command confirms it, and it is true."""
    wait_until(robot.moves, "robot moves")
    began_s = time.monotonic()
    done = arm(robot.endpoint, "--off")
    assert (done.returncode, done.stdout[:33]) == (0, "agilo is disarmed: disarm request"), (done.stdout, done.stderr)
    assert robot.zero_after_s(began_s)
    assert robot.modes()[-1] == "disarmed"


@pytest.mark.slow  # its burners would disturb all tests beside it
@pytest.mark.promise("P52")
def test_disarming_is_confirmed_on_a_busy_machine(tmp_path):
    with guarded_robot(tmp_path) as (session, endpoint, start, trace):
        robot = Driven(session, endpoint, start, trace)
        with burners():
            for _ in range(20):
                disarmed(robot)


@pytest.mark.promise("P52")
@pytest.mark.parametrize(("number", "kills"), [(0, 1), *(pytest.param(n, KILLS, marks=SLOW) for n in range(7))])
def test_disarming_is_confirmed_while_the_executive_restarts(number, kills):
    phases = random.Random(number)
    endpoint = free_endpoint()
    up = Child("up", tailor("up", "soccer", "--scenario", "waypoints", "--connect", endpoint), subprocess.DEVNULL)
    try:
        wait_until(partial(answers, endpoint), "router")
        with open_client(endpoint) as session:
            states, statuses = session.inbox(["driver"], "agilo"), session.inbox(["status"], "")
            newest = partial(newest_state, states)
            wait_until(lambda: newest().mode == "armed", "armed by its executive")
            for _ in range(kills):
                os.kill(child_pid(up.pid, "executive"), signal.SIGKILL)
                time.sleep(phases.uniform(0.0, 1.0))
                done = arm(endpoint, "--off")
                assert done.returncode == 0, (done.stdout, done.stderr)
                assert newest().mode == "disarmed"
                statuses.drain()
                wait_until(statuses.drain, "another executive")  # that `tailor arm` waits for 5 s at most
                done = arm(endpoint)
                assert (done.returncode, done.stdout.split(":")[0]) == (0, "agilo is armed\n"), (
                    done.stdout,
                    done.stderr,
                )
    finally:
        up.stop()


@pytest.mark.promise("P52")
def test_a_forgotten_simulator_beside_the_driver_keeps_it_from_being_armed(tmp_path):
    with guarded_robot(tmp_path) as (session, endpoint, start, _):
        states = session.inbox(["driver"], "agilo")
        forgotten = start("tests.support.stand_ins.sim", endpoint, tmp_path / "trace2")
        epochs = set()
        wait_until(lambda: epochs.update(s.message.epoch for s in states.drain()) or len(epochs) > 1, "second driver")
        done = arm(endpoint, "--sender", "e" * 32)
        assert (done.returncode, done.stdout.split(",")[0]) == (1, "not sent"), (done.stdout, done.stderr)
        assert "several drivers of agilo are on the bus" in done.stdout
        assert {s.message.mode for s in states.drain()} == {"disarmed"}
        forgotten.kill()
        done = arm(endpoint, "--sender", "e" * 32)
        assert (done.returncode, done.stdout) == (0, "agilo is armed\n"), (done.stdout, done.stderr)


class StandingDriver:
    """A driver that goes on telling its state, but stands still before it takes any request."""

    def __init__(self, session):
        self.driver = Driver(DriverSpec("cmd_vel", ("v",), (Limit(-1.0, 1.0),)), epoch=7)
        self.outlet, self.requests = session.publisher("driver", "agilo"), session.inbox(["arm_request"], "agilo")
        self.waiting = []

    def stand(self, seconds):
        ends_s = time.monotonic() + seconds
        while time.monotonic() < ends_s:
            state = self.driver.state(time.monotonic_ns(), 1)
            if state is not None and not self.waiting:
                self.outlet.publish(state)
            self.waiting += self.requests.drain()
            time.sleep(0.01)

    def modes(self):
        """Modes of its guard while it takes what has waited."""
        for sample in self.waiting:
            self.driver.take([sample], {}, time.monotonic_ns())
            yield self.driver.guard.mode


@pytest.mark.promise("P52")
@pytest.mark.parametrize("interrupted", [None, *SIGNALS])
def test_a_request_to_arm_that_nobody_confirmed_arms_nothing_later(interrupted):
    with bus_system() as (session, endpoint, _):
        standing = StandingDriver(session)
        words = tailor("arm", "agilo", "--sender", "e" * 32, "--connect", endpoint)
        with heeded_signals():
            people = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        try:
            wait_until(lambda: standing.stand(0.2) or standing.waiting, "request")
            if interrupted:
                people.send_signal(interrupted)
            wait_until(lambda: standing.stand(0.2) or people.poll() is not None, "end of the command")
            standing.stand(0.5)
        finally:
            people.kill()
            printed = people.communicate()[0]
        modes = list(standing.modes())
        assert (modes[0], modes[-1]) == ("armed", "disarmed"), "it is taken back, and would have armed"
        assert people.returncode == (1 if interrupted is None else 128 + interrupted)
        assert (
            interrupted or printed == "sent, but not confirmed, so it was taken back; agilo is disarmed: just started\n"
        )


@pytest.mark.promise("P52")
@pytest.mark.parametrize("system", [bus_system, secured_system])
def test_no_request_is_lost_behind_another_one(system):
    """Two within a millisecond: so they reach a router that was busy, however far apart people sent them."""
    requests = [ArmRequest(True, False, "e" * 32, 0), ArmRequest(False, False, "", 0)]
    with system() as (session, endpoint, _), open_client(endpoint, role="people") as people:
        heard = {robot: session.inbox(["arm_request"], robot) for robot in ("agilo", "powercube")}
        outlets = [people.publisher("arm_request", robot) for robot in heard]
        wait_until(lambda: all(outlet.matched() for outlet in outlets), "subscriptions")
        for _ in range(10):
            for request in requests:
                for outlet in outlets:
                    outlet.publish(request)
            time.sleep(0.05)
        for robot, inbox in heard.items():
            assert [sample.message for sample in inbox.drain()][-10:] == requests * 5, robot


def newest_state(states):
    return wait_until(lambda: [s.message for s in states.drain() if isinstance(s.message, DriverState)], "state")[-1]
