"""A bad network between executive and driver: partitions and delays, made by a TCP proxy."""

import random
import time
from contextlib import ExitStack, contextmanager

import pytest

from tailor.runtime.bus.opening import open_client
from tailor.schemas.messages import ArmRequest, DriverState
from tests.support.bus_system import armed_sender, driving, guarded_robot, moving, outputs, zero_at
from tests.support.injection.tcp_proxy import tcp_proxy
from tests.support.patience import wait_until
from tests.support.stalls import repeat_on_stall

STOP_S = 0.3 + 0.1  # the guard's time-out and one period
BACK_S = 1.0
RAMP_S_PER_S = 0.1  # of a delay that creeps up
MAX_DELAY_S = 0.3 + 0.1  # the guard's limit; then 0.3 s without a valid command, in which the delay grows by 0.03 s
WAYS = {"both ways": {}, "no commands": {"from_router": False}, "no driver state": {"to_router": False}}
TRIES = [1, pytest.param(20, marks=pytest.mark.slow)]


class Linked:
    """A stand-in robot that moves, and an executive that drives it through a proxy."""

    def __init__(self, session, start, trace, proxy, far):
        self.start, self.trace, self.proxy = start, trace, proxy
        self.commands = session.inbox(["cmd_vel"], "agilo")
        self.states = session.inbox(["driver"], "agilo")
        self.arming = session.publisher("arm_request", "agilo")
        self.far_states = far.inbox(["driver"], "agilo")  # as the executive receives them
        self.executive = driving(start, proxy.endpoint, trace)
        self.sender = armed_sender(self.states)

    def state(self):
        states = [s.message for s in self.states.drain() if isinstance(s.message, DriverState)]
        return states[-1] if states else None

    def drives(self):
        """Arms again whoever was armed first, as people do."""
        if not moving(self.trace, 0.5)():
            self.arming.publish(ArmRequest(True, False, self.sender, 0))
            time.sleep(0.2)
        return moving(self.trace, 0.5)()

    def back_s(self):
        """Seconds until both ends have received what was published from now on; held-up messages do not count."""
        now_s, wall_ns = time.monotonic(), time.time_ns()
        waiting = [(self.commands, now_s * 1e9), (self.far_states, wall_ns)]
        while waiting:
            waiting = [(box, since) for box, since in waiting if not fresh(box, since)]
            time.sleep(0.002)
            assert time.monotonic() < now_s + 20.0, "no data"
        return time.monotonic() - now_s

    def stopped_s(self, since_s):
        """When the output became zero after `since_s`."""
        return wait_until(lambda: zero_at(self.trace, since_s), "zero")


def fresh(box, since_ns):
    """Whether a message with a later stamp has arrived."""
    return any(sample.message.stamp_ns > since_ns for sample in box.drain())


@contextmanager
def linked(tmp_path, delay_s=0.0, jitter_s=0.0):
    with ExitStack() as stack:
        session, endpoint, start, trace = stack.enter_context(guarded_robot(tmp_path))
        proxy = stack.enter_context(tcp_proxy(endpoint))
        proxy.delay(delay_s, jitter_s)
        yield Linked(session, start, trace, proxy, stack.enter_context(open_client(proxy.endpoint)))


@pytest.fixture(scope="module")
def shared(tmp_path_factory):
    with linked(tmp_path_factory.mktemp("robot")) as robot:
        yield robot


@pytest.fixture
def robot(shared):
    """One robot for all interruptions, as for all tries of one: by now, what the last one held up has gone by."""
    shared.proxy.block(False)
    shared.proxy.delay(0.0)
    shared.back_s()
    return shared


def partitioned(robot, phases, way):
    """Interrupts the link; seconds to zero at the guard, and seconds until the data are back."""
    wait_until(robot.drives, "robot moves")
    time.sleep(phases.uniform(0.5, 0.7))
    began_s = time.monotonic()
    robot.proxy.block(**WAYS[way])
    stop_s = 0.0
    if way != "no driver state":
        stop_s = robot.stopped_s(began_s) - began_s
    time.sleep(max(0.0, began_s + phases.uniform(0.5, 2.5) - time.monotonic()))
    stood = outputs(robot.trace)[-1][1] == 0.0
    robot.proxy.block(False)
    back_s = robot.back_s()
    time.sleep(0.5)
    if stood:
        assert outputs(robot.trace)[-1][1] == 0.0, "held-up commands move nothing, and nobody armed again"
    assert stop_s <= STOP_S
    assert back_s <= BACK_S
    return stop_s, back_s


@pytest.mark.promise("P12")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("tries", TRIES)
@pytest.mark.parametrize("way", WAYS)
def test_a_partition_stops_the_robot_and_data_are_back_within_a_second(robot, way, tries, measured):
    phases = random.Random(7)
    for _ in range(tries):
        stop_s, back_s = repeat_on_stall(3, lambda: partitioned(robot, phases, way))
        measured.add(stop_s, STOP_S, what="to zero")
        measured.add(back_s, BACK_S, what="data back")


@pytest.mark.promise("P13")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize(("delay_s", "jitter_s"), [(0.05, 0.05), (0.25, 0.05)])
@pytest.mark.parametrize("drive_s", [3, pytest.param(20, marks=pytest.mark.slow)])
def test_delays_up_to_300_ms_do_not_stop_the_robot(tmp_path, delay_s, jitter_s, drive_s):
    with linked(tmp_path, delay_s, jitter_s) as robot:

        def driven():
            wait_until(robot.drives, "robot moves")
            since_s = time.monotonic()
            time.sleep(drive_s)
            assert [v for at, v in outputs(robot.trace) if at > since_s] == []
            assert wait_until(robot.state, "driver").mode == "armed"

        repeat_on_stall(3, driven)


@pytest.mark.promise("P13")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("tries", TRIES)
def test_a_delay_of_800_ms_that_comes_up_stops_the_robot(robot, tries, measured):
    phases = random.Random(8)

    def delayed():
        robot.proxy.delay(0.0)
        robot.back_s()  # what was held up has gone by
        wait_until(robot.drives, "robot moves")
        time.sleep(phases.uniform(0.5, 0.6))
        since_s = time.monotonic()
        robot.proxy.delay(0.8, 0.1)
        stop_s = robot.stopped_s(since_s) - since_s
        time.sleep(2.0)
        assert outputs(robot.trace)[-1][1] == 0.0, "late commands move nothing"
        assert stop_s <= STOP_S
        return stop_s

    for _ in range(tries):
        measured.add(repeat_on_stall(3, delayed), STOP_S, what="to zero")


@pytest.mark.promise("P13")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("tries", TRIES)
def test_a_delay_that_creeps_up_stops_the_robot(robot, tries, measured):
    def crept():
        robot.proxy.delay(0.0)
        robot.back_s()  # what was held up has gone by
        wait_until(robot.drives, "robot moves")
        since_s = time.monotonic()
        while moving(robot.trace, 0.5)():
            delay_s = RAMP_S_PER_S * (time.monotonic() - since_s)
            robot.proxy.delay(delay_s)
            time.sleep(0.01)
            assert delay_s < 2.0, "the robot drives on"
        assert delay_s > 0.25, "a delay of 250 ms must not stop it"
        time.sleep(1.0)
        assert outputs(robot.trace)[-1][1] == 0.0
        assert delay_s <= MAX_DELAY_S
        return delay_s

    for _ in range(tries):
        measured.add(repeat_on_stall(3, crept), MAX_DELAY_S, what="delay at zero")
