"""A robot with plain topics as Hardware, in this process: what counts as a measurement, and what is a fault."""

import itertools
import math
import socket
import sys
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from io import StringIO

import pytest

from tailor.runtime.bus.opening import open_client, open_router
from tailor.schemas import codec
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import Odometry, PoseEstimate
from tailor.schemas.typesystem import ros_type
from tailor.simnodes.hardware import odometry_check, other_ends, robots_bus
from tailor.simnodes.hardware.plain_keys import address, named
from tailor.simnodes.hardware.plain_robot import TYPES, PlainRobot
from tailor.simnodes.hardware.plain_settings import PlainSettings, PoseSettings, RobotBus, TopicNames
from tailor.tools.commands.drivers.check_driver import _confirm
from tailor.tools.launch.hardware import hardware_of
from tests.support.bus_system import free_endpoint
from tests.support.patience import wait_until

ODOMETRY = Odometry(1_000_000_000, 1.0, 2.0, 0.5, 0.1, 0.2)


@contextmanager
def opened(profile):
    """Yields (publisher of the robot's odometry, the driver's side of it)."""
    codec.prime()
    endpoint = free_endpoint()
    bus = RobotBus(endpoint, profile=profile, domain_id=5)
    robot = PlainRobot(PlainSettings("agilo", bus=bus, pose=PoseSettings((0.0, 0.0, 0.0))), endpoint)
    with open_router(endpoint), open_client(endpoint) as base:
        robot.open()
        try:
            odometry = base.plain_publisher(*address(bus, named("odom", "nav_msgs/msg/Odometry")))
            taken = base.plain_source(address(bus, named("cmd_vel", TYPES["twist_stamped"]))[0])
            wait_until(odometry.matched)
            yield odometry, robot
            assert taken is not None, "kept until here"
        finally:
            robot.close()


@pytest.mark.parametrize("profile", ["plain", "rmw_zenoh"])
def test_odometry_that_repeats_itself_is_no_measurement(profile):
    with opened(profile) as (odometry, robot):
        odometry.publish_encoded(codec.encode(ODOMETRY))
        assert wait_until(robot.read)["odom"] == ODOMETRY
        odometry.publish_encoded(codec.encode(ODOMETRY))
        assert [robot.read() for _ in range(5)] == [{}] * 5
        later = replace(ODOMETRY, stamp_ns=2_000_000_000)
        odometry.publish_encoded(codec.encode(later))
        assert wait_until(robot.read)["odom"] == later


def test_a_robot_opened_again_is_where_odometry_has_carried_it():
    with opened("plain") as (odometry, robot):
        for n in range(3):
            odometry.publish_encoded(codec.encode(replace(ODOMETRY, stamp_ns=(n + 1) * 10**9, phi=0.0, x=1.0 + n)))
            assert wait_until(robot.read)["odom"].x == 1.0 + n
        robot.close()
        robot.open()
        later = replace(ODOMETRY, stamp_ns=4 * 10**9, phi=0.0, x=3.5)
        wait_until(lambda: odometry.publish_encoded(codec.encode(later)) and robot.read())
        pose = robot._tracker.pose()
        assert (pose.x, pose.y) == (2.5, 0.0)
        assert pose.var_x > 0.0
        reset = replace(ODOMETRY, stamp_ns=4_020_000_000, x=0.0)
        odometry.publish_encoded(codec.encode(reset))
        with pytest.raises(ValueError, match="odom: jumped by"):
            wait_until(robot.read)
        assert robot._tracker.pose() is None


@pytest.mark.promise("P63")
def test_two_publishers_of_odometry_are_a_fault_and_one_is_none_afterwards():
    with opened("plain") as (odometry, robot):
        codecs = [codec.encode(replace(ODOMETRY, stamp_ns=10**9 + n, y=2.0 + 0.3 * (n % 2))) for n in range(8)]
        for data in codecs:
            odometry.publish_encoded(data)
        with pytest.raises(ValueError, match=r"odom: moves more than its own speeds say.* until the localiser speaks"):
            wait_until(robot.read)
        assert robot._tracker.pose() is None
        robot.close()
        robot.open()
        later = replace(ODOMETRY, stamp_ns=4 * 10**9, x=1.3)
        assert wait_until(lambda: odometry.publish_encoded(codec.encode(later)) and robot.read()) == {"odom": later}


@pytest.mark.promise("P63")
@pytest.mark.parametrize(("v", "command"), [(99.0, (0.0, 0.0)), (0.0, (99.0, 0.0))], ids=["its speeds", "commands"])
@pytest.mark.parametrize("stamps", [0, 1], ids=["no stamps", "new stamps"])
def test_frozen_odometry_that_looks_fresh_is_a_fault_while_the_robot_moves(monkeypatch, v, command, stamps):
    monkeypatch.setattr(odometry_check, "DEAD_S", 0.0)
    with opened("rmw_zenoh") as (odometry, robot):
        frozen = (replace(ODOMETRY, stamp_ns=n * stamps, v=v, omega=0.0) for n in itertools.count(1))
        robot.write(command)
        with pytest.raises(ValueError, match=r"^odom: repeats itself to the last digit"):
            wait_until(lambda: odometry.publish_encoded(codec.encode(next(frozen))) and not robot.read())


def test_a_base_that_others_may_hold_need_not_obey(monkeypatch):
    """A collision monitor behind the driver held it, and the robot waited for people to arm it again."""
    monkeypatch.setattr(odometry_check, "DEAD_S", 0.0)
    with opened("plain") as (odometry, robot):
        robot._settings = replace(robot._settings, obeys=False)
        robot.write((99.0, 0.0))
        for stamp_ns in range(1, 12):
            odometry.publish_encoded(codec.encode(replace(ODOMETRY, stamp_ns=stamp_ns, v=0.0, omega=0.0)))
            assert wait_until(robot.read)["odom"].stamp_ns == stamp_ns


def test_a_number_that_is_not_finite_is_a_fault_that_names_topic_and_field():
    with opened("plain") as (odometry, robot):
        odometry.publish_encoded(codec.encode(replace(ODOMETRY, v=math.nan)))
        with pytest.raises(ValueError, match=r"^odom: not finite \(twist\.twist\.linear\.x\)$"):
            wait_until(robot.read)


@pytest.mark.promise("P63")
def test_a_localiser_that_is_lost_is_a_fault_and_gives_no_pose():
    with opened("plain") as (odometry, robot):
        odometry.publish_encoded(codec.encode(ODOMETRY))
        assert "pose" in wait_until(robot.read)
        lost = codec.encode(PoseEstimate(10**9, 5.0, 5.0, 0.0, 1e9, 1e9, 1e9))
        with open_client(robot._endpoint) as base:
            localiser = base.plain_publisher(*address(RobotBus(), named("amcl_pose", ros_type(PoseEstimate))))
            wait_until(localiser.matched)
            localiser.publish_encoded(lost)
            with pytest.raises(ValueError, match="amcl_pose: the localiser is lost: standard deviation of 31622"):
                wait_until(robot.read)
        later = replace(ODOMETRY, stamp_ns=2 * 10**9)
        odometry.publish_encoded(codec.encode(later))
        assert wait_until(robot.read) == {"odom": later}


@pytest.mark.promise("P63")
def test_a_base_that_takes_no_commands_gives_no_measurement_but_a_fault():
    """It was armed, and the executive reported time-outs of its actions."""
    with opened("plain") as (odometry, robot):
        misspelt = PlainRobot(replace(robot._settings, topics=TopicNames(cmd_vel="cmd_vell")), robot._endpoint)
        misspelt.open()
        try:
            with pytest.raises(ValueError, match="cmd_vell: nobody takes commands there, expected the base"):
                wait_until(lambda: odometry.publish_encoded(codec.encode(ODOMETRY)) and misspelt.read())
        finally:
            misspelt.close()


@pytest.mark.parametrize(
    ("profile", "why"), [("plain", "nothing has come from there yet"), ("rmw_zenoh", "nobody publishes there")]
)
def test_a_localiser_that_nobody_hears_is_named_until_it_speaks(monkeypatch, profile, why):
    """The executive alone reported `input stale: pose`, of a topic of Tailor's."""
    with opened(profile) as (odometry, robot), open_client(robot._endpoint) as base:
        wait_until(lambda: odometry.publish_encoded(codec.encode(ODOMETRY)) and robot.read())
        monkeypatch.setattr(other_ends, "FIRST_S", 0.0)
        robot.read()
        assert robot.notice == f"amcl_pose: {why}, expected the localiser (topics.pose)"
        localiser = base.plain_publisher(*address(robot._settings.bus, named("amcl_pose", ros_type(PoseEstimate))))
        wait_until(localiser.matched)
        wait_until(lambda: "nothing has come" in (robot.read(), robot.notice)[1])
        pose = codec.encode(PoseEstimate(10**9, 0.0, 0.0, 0.0, 0.01, 0.01, 0.01))
        localiser.publish_encoded(pose)
        wait_until(lambda: (robot.read(), not robot.notice)[1])


@pytest.mark.parametrize("listens", [False, True], ids=["nobody", "another program"])
def test_a_robots_router_that_does_not_respond_is_not_taken_for_tailors_own_bus(monkeypatch, listens):
    """The advice was to start it with `tailor bus`."""
    monkeypatch.setattr(robots_bus, "open_client", partial(open_client, timeout_s=0.3))
    with socket.create_server(("127.0.0.1", 0)) as server:
        endpoint = f"tcp/127.0.0.1:{server.getsockname()[1]}"
        if not listens:
            server.close()
        robot = PlainRobot(PlainSettings("agilo", bus=RobotBus(endpoint)), free_endpoint())
        why = "opens no session of zenoh" if listens else "the robot's router or bridge does not respond"
        with pytest.raises(ConnectionError, match=rf"{endpoint}: {why}.* \(bus\.(connect|key)\)$"):
            robot.open()
        robot.close()


@pytest.mark.parametrize("profile", ["plain", "rmw_zenoh"])
def test_a_wrong_frame_is_a_fault_that_names_the_topic(profile):
    """Under rmw_zenoh its key left no room for the reason."""
    with opened(profile) as (odometry, robot):
        data = codec.encode(ODOMETRY)
        odometry.publish_encoded(data.replace(b"odom\0", b"mood\0", 1))
        with pytest.raises(ValueError, match=r"^odom: its frame is 'mood', expected 'odom'"):
            wait_until(robot.read)


def test_tailors_own_topics_are_no_topics_of_a_robot(tmp_path):
    file = tmp_path / "robot.toml"
    file.write_text('robot = "agilo"\n[topics]\ncmd_vel = "/agilo/cmd_vel"\n')
    with pytest.raises(UsageError, match="agilo/cmd_vel is Tailor's own, past whose guard nothing may drive"):
        hardware_of(str(file), free_endpoint())


@pytest.mark.parametrize(
    ("answer", "is_terminal", "moves"), [("agilo", True, True), ("yes", True, False), ("agilo", False, False)]
)
def test_hardware_is_moved_only_after_its_name_was_typed(monkeypatch, answer, is_terminal, moves):
    terminal = StringIO(f"{answer}\n")
    terminal.isatty = lambda: is_terminal
    monkeypatch.setattr(sys, "stdin", terminal)
    if moves:
        _confirm("agilo", agreed=False)
        return
    with pytest.raises(UsageError, match="confirm"):
        _confirm("agilo", agreed=False)
