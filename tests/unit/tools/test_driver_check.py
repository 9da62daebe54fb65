"""A domain and a driver that do not match are refused at start-up."""

from __future__ import annotations

import dataclasses
from importlib import resources

import pytest

from tailor.executive import domains
from tailor.executive.deliberation.context import PERIOD_NS
from tailor.executive.interfaces.domain import Axis
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import domain_names
from tailor.schemas.messages import VelocityCommand
from tailor.simnodes import driver_spec
from tailor.simnodes.driver_spec import MIN_TIMEOUT_S, SensorSpec, shipped_driver_spec
from tailor.simnodes.guard import Limit
from tailor.tools.launch.checks.driver_check import check_driver, driver_of, sensor_rates_hz
from tailor.tools.main import main

BETWEEN = "expected more than 0.1, the time between two commands, and at most 1"

SOCCER = domains.load("soccer")


@pytest.mark.parametrize("name", domain_names())
def test_every_domain_matches_the_driver_of_its_robot(name):
    domain = domains.load(name)
    check_driver(domain, shipped_driver_spec(domain.robot))


def test_all_mismatches_are_reported_at_once():
    driver = shipped_driver_spec("agilo")
    slow = dataclasses.replace(driver, command_topic="joint_cmd", limits=(Limit(-0.5, 0.5), driver.limits[1]))
    with pytest.raises(UsageError) as caught:
        check_driver(domains.load("soccer"), slow)
    assert "publishes cmd_vel, the driver expects joint_cmd" in str(caught.value)
    assert "v ranges from -0.9 to 0.9 m/s, the driver's limits are -0.5 and 0.5" in str(caught.value)


def test_a_required_sensor_that_the_driver_does_not_list_is_named():
    """A simulator sends it all the same; the driver of the real robot then refused each of its readings."""
    driver = shipped_driver_spec("agilo")
    without_pose = dataclasses.replace(driver, sensors=tuple(each for each in driver.sensors if each.topic != "pose"))
    with pytest.raises(UsageError, match=r"match: pose is required, but no sensor of the driver$"):
        check_driver(SOCCER, without_pose)
    check_driver(SOCCER, dataclasses.replace(driver, sensors=()))  # lists none: a simulator's alone


AXES = {"v": Axis("v", "m/s", -0.5, 0.5), "omega": Axis("omega", "rad/s", -1.5, 1.5)}


class Rover:
    """A domain that says the right thing in cmd_vel, whatever the order of its axes."""

    def __init__(self, *names):
        soccer = domains.load("soccer")
        self.name, self.robot, self.required, self.command_topic = "rover", "rover", soccer.required, "cmd_vel"
        self.axes = tuple(AXES[name] for name in names)

    def message(self, command, stamp_ns):
        said = dict(zip((axis.name for axis in self.axes), command, strict=True))
        return VelocityCommand(stamp_ns, said["v"], said.get("omega", 0.0))


def of(domain):
    """The driver with the same axes."""
    limits = tuple(Limit(axis.lower, axis.upper) for axis in domain.axes)
    axes = tuple(axis.name for axis in domain.axes)
    return dataclasses.replace(shipped_driver_spec("agilo"), axes=axes, limits=limits)


def test_a_driver_that_reads_each_axis_from_its_place_is_accepted():
    rover = Rover("v", "omega")
    check_driver(rover, of(rover))


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (("omega", "v"), "cmd_vel carries -0.75, 0 for omega, v, and the driver reads 0, -0.75"),
        (("v",), "cmd_vel carries -0.166667 for v, and the driver reads -0.166667, 0"),
    ],
)
def test_a_driver_that_reads_another_axis_than_was_written_is_refused(names, expected):
    rover = Rover(*names)
    with pytest.raises(UsageError, match=expected):
        check_driver(rover, of(rover))


def sensing(**rates_hz):
    sensors = tuple(SensorSpec(topic, rate_hz) for topic, rate_hz in rates_hz.items())
    return dataclasses.replace(shipped_driver_spec("agilo"), sensors=sensors)


def test_rates_of_required_sensors_are_those_that_the_driver_declares():
    soccer = domains.load("soccer")
    assert sensor_rates_hz(soccer, sensing(odom=10.0, ball=5.0)) == {"odom": 10.0, "pose": 12.5}
    assert sensor_rates_hz(soccer, sensing(odom=0.0)) == {"odom": 50.0, "pose": 12.5}, "0: that of the topic"


def test_a_driver_whose_sensors_may_just_be_fresh_is_accepted():
    check_driver(domains.load("soccer"), sensing(odom=4.0, pose=2.0))


@pytest.mark.parametrize(
    ("rate_hz", "expected"),
    [
        (3.9, "odom comes at 3.9 Hz, expected at least 4 Hz: it is stale after 0.5 s"),
        (-1.0, "odom comes at -1 Hz, expected at most 1e\\+06 and not less than 0"),
        (1e7, "odom comes at 1e\\+07 Hz, expected at most"),
    ],
)
def test_a_driver_with_a_sensor_too_slow_to_be_fresh_is_refused(rate_hz, expected):
    with pytest.raises(UsageError, match=expected):
        check_driver(domains.load("soccer"), sensing(odom=rate_hz))


COMMAND = '[command]\ntopic = "cmd_vel"\ntimeout_s = 0.3\naxes = [{ name = "v", lower = -1, upper = 1 }]\n'


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "command is missing, expected a table (docs/robots/driver.md)"),
        ("command = 5", "command is 5, expected a table"),
        ("commands = []", "commands is [], expected a list of tables, at least one"),
        ("commands = [5]", "commands is [5], expected a list of tables, at least one"),
        (COMMAND.replace('"cmd_vel"', "5"), "topic is 5, expected text"),
        (COMMAND.replace('"v"', "[1]"), "name is [1], expected text"),
        (COMMAND.replace("upper = 1", f"upper = 1{'0' * 400}"), "expected a finite number"),
        (COMMAND.replace("[{", "[[").replace("}]", "]]").replace("name = ", ""), "not TOML"),
        (COMMAND.replace("timeout_s = 0.3\n", ""), "timeout_s is missing, expected a finite number"),
        ("sensors = 5\n" + COMMAND, "sensors is 5, expected a table"),
        (COMMAND + "[sensors]\nodom = 5", "odom is 5, expected a table"),
        (COMMAND + "[sensors]\nodom = { frame = 5 }", "frame is 5, expected text"),
        (COMMAND + "[sensors]\nodom = { rate_hz = 0 }", "odom: rate_hz is 0, expected more than 0"),
        (COMMAND + "[sensors]\nodom = { rate_hz = -0.0 }", "odom: rate_hz is -0, expected more than 0"),
        (COMMAND + "[sensors]\nodom = { rate_hz = -50 }", "odom: rate_hz is -50, expected more than 0"),
        ("a = " + "[" * 5000, "nested too deeply"),
        ("# \xe9", "not UTF-8"),
    ],
)
def test_a_file_that_specifies_no_driver_is_refused_in_one_line(tmp_path, text, expected):
    file = tmp_path / "driver.toml"
    file.write_bytes(text.encode("latin-1"))
    with pytest.raises(UsageError) as caught:
        driver_of(SOCCER, str(file))
    assert expected in str(caught.value)
    assert "the specification of a driver" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_driver_is_specified_by_its_command_alone(tmp_path):
    (tmp_path / "driver.toml").write_text(COMMAND)
    assert driver_of(SOCCER, str(tmp_path / "driver.toml")).axes == ("v",)


def altered(folder, line, wrong):
    """The specification of AGILO's driver with one line changed."""
    text = resources.files("tailor.simnodes").joinpath("agilo", "driver.toml").read_text()
    assert line in text
    (folder / "driver.toml").write_text(text.replace(line, wrong))
    return folder / "driver.toml"


@pytest.mark.parametrize(
    ("line", "wrong", "expected"),
    [
        ("rate_hz = 50", "rate = 50", "sensors.odom: unknown key 'rate', expected one of: rate_hz, frame"),
        ("timeout_s = 0.3", "timeout_s = 0.3\ntimeout_ms = 100", "cmd_vel: unknown key 'timeout_ms', expected one of:"),
        ('unit = "m/s"', 'unit = "km/h"', "v has the unit 'km/h', expected m/s as the domain"),
        ('robot = "agilo"', 'robot = "hal"', "robot is 'hal', expected 'agilo'"),
        ("ball =", "lidar =", "sensors: there is no topic 'lidar'"),
    ],
)
def test_what_nobody_would_read_in_a_specification_is_refused(tmp_path, line, wrong, expected):
    file = altered(tmp_path, line, wrong)
    with pytest.raises(UsageError) as caught:
        driver_of(SOCCER, str(file))
    assert str(caught.value).startswith(f"{file}: {expected}")
    assert "\n" not in str(caught.value)


@pytest.mark.promise("P39")
@pytest.mark.parametrize(
    ("line", "wrong", "expected"),
    [
        ("timeout_s = 0.3", "timeout_s = 0", f"timeout_s is 0, {BETWEEN}"),
        ("timeout_s = 0.3", "timeout_s = 0.1", f"timeout_s is 0.1, {BETWEEN}"),
        ("timeout_s = 0.3", "timeout_s = 1e9", f"timeout_s is 1e\\+09, {BETWEEN}"),
        ("timeout_s = 0.3", "timeout_s = nan", "timeout_s is nan, expected a finite number"),
        ("upper = 0.9", 'upper = "0.9"', "upper is '0.9', expected a finite number"),
        ("upper = 0.9", "upper = inf", "upper is inf, expected a finite number"),
        ("upper = 0.9", "upper = -2.0", "v goes from -0.9 to -2, expected the lower limit first"),
    ],
)
def test_a_specification_that_would_disable_the_guard_is_refused(tmp_path, line, wrong, expected):
    with pytest.raises(UsageError, match=expected):
        driver_of(SOCCER, str(altered(tmp_path, line, wrong)))


AGILO = driver_spec.file(driver_spec.spec_of_robot("agilo"), "driver").read_text()


@pytest.mark.parametrize(("old", "new"), [('topic = "cmd_vel"', 'topic = "wheels"'), ("odom =", "wheels =")])
def test_a_topic_that_nobody_declares_is_named_before_the_bus_is_opened(tmp_path, monkeypatch, capsys, old, new):
    """It ended `tailor driver` and `tailor sim` in a traceback, and systemd started them again and again."""
    written = tmp_path / "driver.toml"
    written.write_text(AGILO.replace(old, new))
    monkeypatch.setattr(driver_spec, "file", lambda *_: written)
    with pytest.raises(UsageError, match=r"driver\.toml: there is no topic 'wheels', expected one of the package"):
        driver_spec.driver_spec_to_run("agilo")
    assert main(["sim", "agilo"]) == 2
    assert "there is no topic 'wheels'" in capsys.readouterr().err


def test_a_driver_whose_topics_are_all_declared_runs():
    assert driver_spec.driver_spec_to_run("agilo") == driver_spec.shipped_driver_spec("agilo")


def test_the_least_timeout_is_the_period_of_the_executive():
    assert round(1e9 * MIN_TIMEOUT_S) == PERIOD_NS
