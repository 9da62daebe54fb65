"""A robot that knows nothing of Tailor is driven by a TOML file alone, and stops whoever dies."""

import json
import os
import signal
import time
from contextlib import contextmanager
from importlib import resources
from pathlib import Path
from typing import NamedTuple

import pytest

from tailor.executive import domains
from tailor.runtime.bus.opening import open_client
from tailor.schemas.messages import Odometry, PoseEstimate
from tailor.schemas.typesystem import ros_type
from tailor.simnodes.hardware.plain_keys import named
from tailor.simnodes.hardware.plain_robot import TYPES
from tailor.tools.launch.hosting import free_endpoint
from tests.support.bus_system import accepts, answers, started
from tests.support.patience import wait_until
from tests.support.robots.driving import achieved, arm, executive_on, newest, ready

GUARD_S, BASE_S, RAMP_S = 0.3, 0.5, 0.9 / 0.65  # the guard's timeout, the base's own, and the time to come to rest
BUSY_S = 1.0  # of a machine that runs other tests


class System(NamedTuple):
    session: object
    endpoint: str
    start: object
    trace: Path
    driver: object
    base: object
    bus: object
    robots_bus: object


def shipped_file(robot):
    """Text of the driver.toml that ships for a robot."""
    return resources.files("tailor.simnodes").joinpath(robot, "driver.toml").read_text()


@contextmanager
def killable_bus(profile="plain"):
    """A bus in its own process: yields (session, endpoint, start, bus)."""
    endpoint = free_endpoint()
    with started() as start:
        bus = start("tailor.tools.main", "bus", "--security", "open", "--profile", profile, "--connect", endpoint)
        wait_until(lambda: accepts(endpoint) and answers(endpoint), "bus")
        with open_client(endpoint) as session:
            yield session, endpoint, start, bus


def keys(profile, robot):
    """The keys of the robot's own topics under rmw_zenoh; under the plain profile its names are its keys."""
    types = {
        "cmd_vel": TYPES[robot.get("command", "twist")],
        "odom": ros_type(Odometry),
        "amcl_pose": ros_type(PoseEstimate),
    }
    found = {name: named(name, each).key(0) for name, each in types.items()} if profile == "rmw_zenoh" else {}
    return {("pose" if name == "amcl_pose" else name): key for name, key in found.items()}


@contextmanager
def driven(tmp_path, domain="soccer", scenario="waypoints", profile="plain", robot_name="agilo", **robot):
    """A stand-in robot on a bus of its own behind `tailor driver`, both buses of a key profile: yields a System."""
    start_pose = domains.seeded_scenario(domain, scenario, 0)[1]
    pose = [start_pose[name] for name in ("x", "y", "phi")]
    trace, file = tmp_path / "trace", tmp_path / "robot.toml"
    with (
        killable_bus(profile) as (session, endpoint, start, bus),
        killable_bus() as (_, robots, start_robot, robots_bus),
    ):
        options = {"endpoint": robots, "trace": str(trace), "start": pose, **keys(profile, robot), **robot}
        base = start_robot("tests.support.stand_ins.plain_robot", json.dumps(options))
        command = options.get("command", "twist")
        file.write_text(
            f'robot = "{robot_name}"\ncommand = "{command}"\n[bus]\nconnect = "{robots}"\nprofile = "{profile}"\n'
            f'[topics]\npose = "{robot.get("pose", "amcl_pose")}"\n[pose]\nstart = {pose}\n'
        )
        driver = start("tailor.tools.main", "driver", file, "--connect", endpoint)
        yield System(session, endpoint, start, trace, driver, base, bus, robots_bus)


def rows(trace):
    """[(monotonic s, v, omega, wanted v)]"""
    lines = [line.split() for line in trace.read_text().splitlines()]
    return [(int(row[0]) / 1e9, *map(float, row[1:])) for row in lines if len(row) == 4]


def moving(trace):
    return lambda: trace.exists() and rows(trace) and rows(trace)[-1][1] > 0.2


def at_rest(trace):
    return lambda: rows(trace)[-1][1:3] == (0.0, 0.0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "robot"),
    [("twist", {}), ("twist_stamped", {"pose": ""}), ("twist_stamped", {"profile": "rmw_zenoh"})],
)
def test_a_plain_robot_drives_through_its_waypoints(tmp_path, command, robot):
    with driven(tmp_path, command=command, **robot) as (session, endpoint, start, trace, *_):
        ready(session, "agilo")
        executive = executive_on(start, endpoint, "soccer", "waypoints")
        arm(session, "agilo")
        assert achieved(executive)
        wait_until(at_rest(trace), "rest")


@pytest.mark.slow
def test_a_robot_with_odometry_at_10_hz_drives_where_its_driver_file_declares_that(tmp_path):
    text = shipped_file("agilo")
    declared = tmp_path / "driver.toml"
    declared.write_text(text.replace("rate_hz = 50", "rate_hz = 10").replace("rate_hz = 12.5", "rate_hz = 10"))
    with driven(tmp_path, odom_every=5) as (session, endpoint, start, trace, *_):
        ready(session, "agilo")
        executive = executive_on(start, endpoint, "soccer", "waypoints", "--driver", declared)
        arm(session, "agilo")
        assert achieved(executive)
        wait_until(at_rest(trace), "rest")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("dies", "limit_s"),
    [
        ("executive", GUARD_S),
        ("bus", GUARD_S),
        ("driver", BASE_S),
        ("executive, driver", BASE_S),
        ("robots_bus", BASE_S),
    ],
)
def test_a_plain_robot_stops_whoever_is_killed(tmp_path, dies, limit_s):
    with driven(tmp_path) as system:
        session, trace = system.session, system.trace
        ready(session, "agilo")
        executive = executive_on(system.start, system.endpoint, "soccer", "waypoints")
        arm(session, "agilo")
        wait_until(moving(trace), "motion")
        for name in dies.split(", "):
            os.kill((executive if name == "executive" else getattr(system, name)).pid, signal.SIGKILL)
        killed_s = time.monotonic()
        wait_until(at_rest(trace), "rest")
        stopped_s = next(row[0] for row in rows(trace)[::-1] if row[3] != 0.0)  # last time that it was to move
        assert stopped_s - killed_s < limit_s + BUSY_S
        assert rows(trace)[-1][0] - killed_s < limit_s + RAMP_S + BUSY_S
        if dies == "executive":
            state = newest(session.inbox(["driver"], "agilo")) or ready(session, "agilo")
            assert (state.mode, state.reason) == ("stopped", "no valid command in time")


def is_fault(state):
    silent = state.detail.startswith("odom: silent for 0.5 s")
    return (state.mode, state.reason, silent) == ("stopped", "driver fault", True)


@pytest.mark.slow
def test_a_robot_whose_odometry_repeats_itself_is_stopped(tmp_path):
    with driven(tmp_path) as (session, endpoint, start, trace, _, base, *_):
        states = session.inbox(["driver"], "agilo", newest_only=False)
        ready(session, "agilo")
        executive_on(start, endpoint, "soccer", "waypoints")
        arm(session, "agilo")
        wait_until(moving(trace), "motion")
        os.kill(base.pid, signal.SIGUSR1)
        # On a busy machine the guard may stop before, for want of commands, and the driver fail again 3 s later.
        wait_until(lambda: newest(states, is_fault), "stop for silent odometry")
        wait_until(at_rest(trace), "rest")


def test_a_wrong_frame_is_published_as_a_fault(tmp_path):
    with driven(tmp_path, odom_frame="world") as (session, *_):
        states = session.inbox(["driver"], "agilo")
        state = wait_until(lambda: newest(states, lambda m: m.reason == "driver fault"), "fault")
        assert "its frame is 'world', expected 'odom'" in state.detail
