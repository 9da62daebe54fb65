"""Whatever a robot's hardware does, the robot is stopped, the reason is published, and it is tried again."""

import asyncio
import itertools
import math
import threading
from dataclasses import replace

import pytest

from tailor.runtime.clock import MonotonicClock
from tailor.schemas.codec import decode, encode
from tailor.schemas.messages import ArmRequest, DriverState, EStop, Odometry, PoseEstimate, Sample, VelocityCommand
from tailor.simnodes.driver_spec import DriverSpec, SensorSpec
from tailor.simnodes.guard import ArmRefusal, Limit
from tailor.simnodes.hardware.device import Device
from tailor.simnodes.hardware.node import HardwareNode
from tailor.simnodes.hardware.watchdogs import RetryPolicy, SensorWatch, watched_sensors
from tests.support.patience import wait_until
from tests.unit.simnodes.hardware.faulty import PATIENT_S, Bus, Faulty

EXECUTIVE, PERSON = "a" * 32, "b" * 32
SPEC = DriverSpec(
    "cmd_vel",
    ("v", "omega"),
    (Limit(-1.0, 1.0), Limit(-2.0, 2.0)),
    timeout_ns=3_000_000_000,  # no test waits for it
    sensors=(SensorSpec("odom", 50.0),),
)


class Robot:
    """A node in a thread of its own."""

    def __init__(self, hardware, attempts=0, spec=SPEC, watched=False):
        """`watched`: its sensors may be silent as long as the driver allows, and not as long as a call may take."""
        self.hardware, self.bus, self.numbers = hardware, Bus(), itertools.count(1)
        retry = RetryPolicy(first_s=0.05, most_s=0.05, attempts=attempts)
        self.clock, self.reports = MonotonicClock(), []
        self.node = HardwareNode(hardware, spec, self.bus, self.clock, epoch=7, retry=retry, report=self.reports.append)
        if not watched:  # while a machine stands still every sensor is silent
            names = watched_sensors(each.topic for each in spec.sensors)
            self.node._watch = SensorWatch(dict.fromkeys(names, PATIENT_S))
        self.ended, self.outcome = threading.Event(), []
        self.thread = threading.Thread(target=lambda: self.outcome.append(self.node.run(self.ended.is_set)))
        self.thread.start()

    def send(self, message, topic, sender=EXECUTIVE):
        sample = Sample(f"agilo/{topic}", message, self.clock.now_ns(), next(self.numbers), sender)
        self.bus.waiting.append(sample)

    def state(self):
        states = self.bus.published["driver"]
        return states[-1] if states else None

    def is_in(self, mode):
        return lambda: self.state() is not None and self.state().mode == mode

    def drive(self):
        """Arms and moves it."""
        wait_until(lambda: not self.node.driver.unready, "ready", 5)
        self.send(ArmRequest(True, False, EXECUTIVE, 0), "arm_request", PERSON)
        self.send(VelocityCommand(0, 0.5, 0.1), "cmd_vel")
        wait_until(lambda: self.hardware.written[-1:] == [(0.5, 0.1)], "motion", 5)

    def end(self):
        self.ended.set()
        self.hardware.released.set()
        self.thread.join(5)
        assert not self.thread.is_alive()


@pytest.fixture
def robot():
    robots = []

    def make(hardware=None, **options):
        robots.append(Robot(hardware or Faulty(), **options))
        return robots[-1]

    yield make
    for each in robots:
        each.end()


def stopped_for(robot, reason):
    """Waits until the robot is stopped for that reason, at rest."""
    state = wait_until(lambda: robot.is_in("stopped")() and robot.state(), "stop", 5)
    assert (state.reason, reason in state.detail) == ("driver fault", True), state.detail
    wait_until(lambda: robot.hardware.written[-1:] in ([], [(0.0, 0.0)]), "rest", 5)


def test_hardware_that_opens_at_once_and_has_no_watched_sensor_can_be_armed(robot):
    hardware = Faulty()
    hardware.odometry = {"pose": PoseEstimate(0, 0.0, 0.0, 0.0, 0.01, 0.01, 0.01)}
    driven = robot(hardware, spec=replace(SPEC, sensors=(SensorSpec("pose", 12.5),)))
    driven.drive()
    assert driven.reports == ["ready"]


def test_commands_reach_the_hardware_and_measurements_the_bus(robot):
    driven = robot()
    driven.drive()
    assert driven.is_in("armed")()
    odometry = wait_until(lambda: driven.bus.published["odom"], "odometry", 5)
    assert odometry[0].stamp_ns > 0
    driven.end()
    assert driven.outcome == [True]
    assert driven.hardware.written[-1] == (0.0, 0.0)
    assert driven.hardware.order[-1] == "close"
    assert driven.state().reason == "the driver ends"


def test_a_notice_of_the_hardware_is_reported_and_stands_in_the_state_of_a_driver_that_can_be_armed(robot):
    hardware = Faulty()
    hardware.notice = "the lidar is\ndirty" + 1000 * "!"
    driven = robot(hardware)
    driven.drive()
    state = wait_until(lambda: driven.is_in("armed")() and driven.state(), "armed", 5)
    assert state.detail.startswith("the lidar is dirty!!!")
    assert isinstance(decode(DriverState, encode(state)), DriverState), "others can read it"
    assert [line[:18] for line in driven.reports if line.startswith("the")] == ["the lidar is dirty"]
    hardware.notice = ""
    wait_until(lambda: driven.state().detail == "", "no notice", 5)


def test_hardware_that_does_not_open_is_tried_again_and_cannot_be_armed(robot):
    hardware = Faulty()
    hardware.raises = {"open"}
    driven = robot(hardware)
    stopped_for(driven, "open: OSError: no open")
    driven.send(ArmRequest(True, False, EXECUTIVE, 0), "arm_request", PERSON)
    refused = wait_until(lambda: dict(driven.node.driver._arm_refused), "refusal", 5)
    assert refused == {ArmRefusal.NOT_READY: 1}
    wait_until(lambda: hardware.calls["open"] > 2, "further attempts", 5)
    hardware.raises = set()
    driven.drive()


@pytest.mark.parametrize(
    ("kind", "method", "reason"),
    [
        ("raises", "read", "read: OSError: no read"),
        ("raises", "write", "write: OSError: no write"),
        ("stalls", "read", "read: stalled for 0.5 s"),
        ("stalls", "write", "write: stalled for 0.5 s"),
    ],
)
def test_a_fault_stops_the_robot_until_a_person_arms_it_again(robot, kind, method, reason):
    driven = robot(Faulty(impatient={method} if kind == "stalls" else ()))
    driven.drive()
    setattr(driven.hardware, kind, {method})
    stopped_for(driven, reason)
    setattr(driven.hardware, kind, set())
    driven.hardware.released.set()
    wait_until(lambda: driven.hardware.calls["open"] > 1 and not driven.node.driver.unready, "open again", 5)
    assert driven.hardware.calls["close"] == 1
    assert driven.is_in("stopped")(), "it is ready, and waits for a person"
    driven.drive()


@pytest.mark.parametrize("kind", ["raises", "stalls"])
def test_hardware_that_cannot_be_opened_again_says_why(robot, kind):
    """A plug that was pulled stayed `odom: silent` while its port was missing."""
    driven = robot(Faulty(impatient={"open"}))
    driven.drive()
    setattr(driven.hardware, kind, {"open"})
    driven.hardware.raises = {*driven.hardware.raises, "read"}
    stopped_for(driven, "read: OSError: no read")
    wait_until(lambda: driven.state().detail.startswith("read: OSError: no read; not ready: open: "), "both reasons", 5)
    driven.hardware.released.set()
    driven.hardware.raises, driven.hardware.stalls = set(), set()
    driven.drive()


@pytest.mark.parametrize("error", [SystemExit, asyncio.CancelledError])
def test_no_exception_ends_the_writing_unseen(robot, error):
    driven = robot()
    driven.drive()
    driven.hardware.error, driven.hardware.raises = error, {"write"}
    stopped_for(driven, f"write: {error.__name__}: no write")


class Mute(Exception):
    """Of a library whose exceptions cannot be printed."""

    def __str__(self):
        return self.text


@pytest.mark.parametrize(
    ("error", "reason"),
    [
        (lambda _: OSError("no port /dev/tty\udcff"), r"read: OSError: no port /dev/tty\udcff"),
        (lambda _: Mute(), "read: Mute: without a text, since its __str__ raises AttributeError"),
        (lambda _: OSError("x" * 10_000), "read: OSError: xxx"),
    ],
)
def test_whatever_a_fault_says_the_driver_reports_it_and_goes_on(robot, error, reason):
    """A name of a file that is no UTF-8 ended the driver: no bus carries it."""
    driven = robot()
    driven.drive()
    driven.hardware.error, driven.hardware.raises = error, {"read"}
    stopped_for(driven, reason)
    assert isinstance(decode(DriverState, encode(driven.state())), DriverState), "others can read it"
    driven.hardware.raises = set()
    driven.drive()


def test_a_measurement_whose_error_is_long_is_a_fault_that_others_can_read(robot):
    driven = robot()
    driven.drive()
    driven.hardware.odometry = {"x" * 10_000: Odometry(0, 0.0, 0.0, 0.0, 0.0, 0.0)}
    stopped_for(driven, "read: 'xxx")
    assert isinstance(decode(DriverState, encode(driven.state())), DriverState)


def test_standstill_is_written_while_a_read_stalls_and_close_ends_the_read(robot):
    driven = robot(Faulty(impatient={"read"}))
    driven.drive()
    driven.hardware.stalls = {"read", "close frees"}
    stopped_for(driven, "read: stalled")
    wait_until(lambda: driven.hardware.calls["open"] > 1, "open again", 10)
    assert driven.hardware.freed, "the read waited until it gave up by itself"
    before_close = driven.hardware.order[: driven.hardware.order.index("close")]
    assert "write" in before_close[len(before_close) - before_close[::-1].index("read") :]


def test_hardware_is_not_opened_while_a_call_is_still_inside_it(robot):
    driven = robot(Faulty(impatient={"read"}))
    driven.drive()
    driven.hardware.stalls = {"read"}
    stopped_for(driven, "read: stalled")
    wait_until(lambda: driven.hardware.calls["close"], "close", 5)
    threading.Event().wait(0.3)
    assert driven.hardware.calls["open"] == 1


def test_a_silent_sensor_stops_the_robot(robot):
    driven = robot(watched=True)
    driven.drive()
    driven.hardware.silent = True
    stopped_for(driven, "odom: silent for 0.5 s")


@pytest.mark.parametrize("stamp_ns", [0, 1])
def test_a_sensor_that_repeats_its_last_message_is_silent(robot, stamp_ns):
    """A class returned what its device's thread had left there: 8700 times a second, fresh for ever."""
    driven = robot(watched=True)
    driven.drive()
    last = Odometry(stamp_ns, 0.5, 0.0, 0.0, 0.3, 0.0)
    driven.hardware.read = lambda: {"odom": replace(last) if stamp_ns else last}
    stopped_for(driven, "odom: silent for 0.5 s")
    assert [each for each in driven.bus.published["odom"] if each.x == 0.5] == driven.bus.published["odom"][-1:]


def test_a_class_may_return_the_mapping_of_before_filled_again(robot):
    hardware, filled = Faulty(), {}

    def read():
        threading.Event().wait(0.001)
        filled["odom"] = Odometry(0, float(len(taken)), 0.0, 0.0, 0.0, 0.0)
        taken.append(filled["odom"].x)
        return filled

    taken, hardware.read = [], read
    driven = robot(hardware)
    published = wait_until(
        lambda: driven.bus.published["odom"][50:] and driven.bus.published["odom"][:50], "odometry", 5
    )
    assert [each.x for each in published] == [float(n) for n in range(50)]


def test_a_read_that_stalls_is_named_rather_than_the_sensor_that_it_leaves_silent(robot, monkeypatch):
    """Also where a busy machine lets it begin late, so that the sensor is silent for longer."""
    driven = robot(Faulty(impatient={"read"}), watched=True)
    heard = driven.node._watch.heard
    monkeypatch.setattr(driven.node._watch, "heard", lambda topic, at_ns: heard(topic, at_ns - 50_000_000))
    driven.drive()
    driven.hardware.stalls = {"read"}
    stopped_for(driven, "read: stalled for 0.5 s")


def test_a_robot_without_odometry_cannot_be_armed(robot):
    hardware = Faulty()
    hardware.silent = True
    driven = robot(hardware)
    wait_until(lambda: driven.node.driver.unready == "no odom yet", "open", 5)
    assert driven.node.driver.guard.mode == "disarmed"


def test_a_measurement_that_is_not_declared_is_a_fault(robot):
    driven = robot()
    driven.drive()
    driven.hardware.odometry = {"pose": PoseEstimate(0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0)}
    stopped_for(driven, "'pose' is no sensor")


def test_a_measurement_of_another_type_is_a_fault(robot):
    driven = robot()
    driven.drive()
    driven.hardware.odometry = {"odom": PoseEstimate(0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0)}
    stopped_for(driven, "odom is no Odometry")


def test_what_a_read_returns_that_is_no_mapping_is_a_fault(robot):
    driven = robot()
    driven.drive()
    driven.hardware.odometry = [1, 2]
    stopped_for(driven, "read: TypeError: returned list, expected messages by topic")


def test_after_a_fault_nothing_from_before_it_is_written_even_if_the_loop_hangs():
    hardware = Faulty()
    device = Device(hardware, SPEC.limits, RetryPolicy(first_s=0.05, most_s=0.05), MonotonicClock())
    device.start()
    wait_until(lambda: hardware.written, "the first set-point", 5)
    device.hand((0.5, 0.1), MonotonicClock().now_ns())
    wait_until(lambda: hardware.written[-1] == (0.5, 0.1), "motion", 5)
    hardware.raises = {"read"}  # and nobody hands set-points any more
    wait_until(lambda: hardware.calls["open"] > 1, "open again", 5)
    hardware.raises, hardware.written = set(), []
    wait_until(lambda: len(hardware.written) > 3, "set-points", 5)
    assert set(hardware.written) == {(0.0, 0.0)}
    assert device.end()


@pytest.mark.parametrize(
    ("x", "reason"), [(math.nan, "not finite (pose.pose.position.x)"), (1e300, "number too large")]
)
def test_a_sensor_whose_measurements_every_receiver_refuses_stops_the_robot(robot, x, reason):
    """They kept it fresh: the driver stayed armed and reported nothing, while the executive had no odometry."""
    driven = robot(watched=True)
    driven.drive()
    driven.hardware.odometry = {"odom": Odometry(0, x, 0.0, 0.0, 0.0, 0.0)}
    stopped_for(driven, f"odom: {reason} for 0.5 s")
    driven.hardware.odometry = {}
    driven.drive()


def test_one_measurement_that_is_refused_stops_nobody(robot):
    driven = robot()
    driven.drive()
    for x in (math.nan, 0.0):
        driven.hardware.odometry = {"odom": Odometry(0, x, 0.0, 0.0, 0.0, 0.0)}
        calls = driven.hardware.calls["read"]
        wait_until(lambda calls=calls: driven.hardware.calls["read"] > calls + 2, "measurements", 5)
    assert driven.state().mode == "armed"
    unheard_ns = driven.clock.now_ns() + int((PATIENT_S + 1) * 1e9)
    assert driven.node._watch.fault(unheard_ns).startswith("odom: silent"), "the refusal is over"


@pytest.mark.parametrize(
    ("odometry", "what"),
    [
        (Odometry(0, None, 0.0, 0.0, "0.1", 0.0), "x is NoneType, expected float; v is str, expected float"),
        (Odometry(1.76e18, 0.0, 0.0, 0.0, 0.0, 0.0), "stamp_ns is float, expected int"),
        (Odometry(2**62, *[0.0] * 5), "error: "),
    ],
)
def test_a_measurement_that_cannot_be_encoded_is_a_fault(robot, odometry, what):
    """It did not name the field, of perhaps a dozen: `error: required argument is not a float`."""
    driven = robot()
    driven.drive()
    driven.hardware.odometry = {"odom": odometry}
    stopped_for(driven, f"read: odom cannot be encoded: {what}")
    driven.hardware.odometry = {}
    driven.drive()


def test_a_mistake_of_the_driver_itself_leaves_the_robot_at_rest_and_its_device_closed(robot, monkeypatch):
    driven = robot()
    driven.drive()
    monkeypatch.setattr(threading, "excepthook", lambda _: None)
    monkeypatch.setattr(driven.node, "_judge", lambda now_ns: 1 / 0)
    driven.thread.join(5)
    assert driven.hardware.written[-1] == (0.0, 0.0)
    assert driven.hardware.order[-1] == "close"


def test_an_estop_stops_the_hardware_and_stays_latched_through_a_fault(robot):
    driven = robot()
    driven.drive()
    driven.send(EStop(True), "estop", PERSON)
    wait_until(driven.is_in("estopped"), "e-stop", 5)
    wait_until(lambda: driven.hardware.written[-1] == (0.0, 0.0), "rest", 5)
    driven.hardware.raises = {"read"}
    wait_until(lambda: driven.hardware.calls["close"], "fault", 5)
    assert driven.is_in("estopped")()


def test_the_policy_ends_the_driver_after_its_attempts(robot):
    hardware = Faulty()
    hardware.raises = {"open"}
    driven = robot(hardware, attempts=3)
    driven.thread.join(5)
    assert driven.outcome == [False]
    assert hardware.calls["open"] == 3
    assert "not ready: open: OSError: no open" in driven.reports


def test_pauses_between_attempts_grow_to_a_limit():
    policy = RetryPolicy(1.0, 2.0, 10.0, attempts=7)
    assert [policy.pause_s(faults) for faults in range(1, 8)] == [1.0, 2.0, 4.0, 8.0, 10.0, 10.0, None]


def test_a_measurement_of_a_type_without_stamps_is_published(robot):
    """It was a fault, `cannot be encoded`, so that such a robot was never ready."""
    spec = replace(SPEC, sensors=(*SPEC.sensors, SensorSpec("estop", 0.0)))  # of those that ship, the one without
    driven = robot(Faulty(), spec=spec)
    driven.hardware.odometry = {"odom": Odometry(0, *[0.0] * 5), "estop": EStop(False)}
    wait_until(lambda: driven.bus.published["estop"], "published", 5)
    assert driven.bus.published["estop"][-1] == EStop(False)
    assert not driven.node.device.fault


def test_a_notice_is_printed_again_only_where_more_than_its_numbers_has_changed(robot):
    """A voltage filled the log of a driver with fifty lines a second."""
    driven = robot()
    hardware, shown = driven.hardware, set()
    wait_until(lambda: "ready" in driven.reports, "ready", 5)

    def tells(text):
        def told():
            hardware.notice = text.format(11.0 + 0.01 * len(shown))
            shown.add(driven.node.driver.notice)
            return len([each for each in shown if each.startswith(text[:7])]) > 3

        wait_until(told, "notices in the driver's state", 5)

    tells("battery {:.2f} V")
    tells("voltage {:.2f} V")
    assert [line[:7] for line in driven.reports if line.endswith("V")] == ["battery", "voltage"]
