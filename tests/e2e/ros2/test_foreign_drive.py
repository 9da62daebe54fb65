"""A node of zenoh-ros2-sdk at a running system: it gives a goal, watches the robot drive there, and stops it."""

import itertools
import math
import subprocess

import pytest

from tailor.runtime.bus.opening import open_client
from tailor.runtime.processes.child import tailor
from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.ros2.profiles import KeyProfile
from tests.support.bus_system import bus_system
from tests.support.patience import wait_until
from tests.support.robots.driving import LONG_S, arm, ready

sdk = pytest.importorskip("zenoh_ros2_sdk")
node = pytest.importorskip("tests.support.ros2.sdk")
MAIN = "tailor.tools.main"


@pytest.mark.slow
def test_it_gives_a_goal_watches_and_stops_the_robot(tmp_path):
    record = tmp_path / "run.mcap"
    with bus_system() as (_, endpoint, start):
        flags = ("--connect", endpoint, "--profile", "rmw_zenoh")
        recorder = start(MAIN, "record", "-o", record, *flags)
        wait_until(record.exists, "recorder, which must not miss the first tick")
        start(MAIN, "sim", "agilo", "--scenario", "waypoints", *flags)
        start(MAIN, "executive", "soccer", "--scenario", "waypoints", "--wait", *flags)
        with (
            open_client(endpoint, role="people", keys=KeyProfile("rmw_zenoh")) as people,
            node.sdk_node(endpoint, tmp_path / "definitions") as make,
        ):
            seen = {name: [] for name in ("odom", "status", "driver")}
            make(sdk.ROS2Subscriber, "/agilo/odom", "nav_msgs/msg/Odometry", seen["odom"].append)
            make(sdk.ROS2Subscriber, "/exec/status", "tailor_msgs/msg/ExecStatus", seen["status"].append)
            make(sdk.ROS2Subscriber, "/agilo/driver", "tailor_msgs/msg/DriverState", seen["driver"].append)
            ready(people, "agilo")
            arm(people, "agilo")
            client = make(sdk.ROS2ServiceClient, "/exec/set_goal", "tailor_msgs/srv/SetGoal", timeout=60.0)
            refused = client.call(goal="(nonsense")
            assert (refused.accepted, bool(refused.message)) == (False, True)
            assert client.call(goal="").accepted
            wait_until(lambda: seen["status"] and seen["status"][-1].result == "achieved", "goal", LONG_S)
            path = [(each.pose.pose.position.x, each.pose.pose.position.y) for each in seen["odom"]]
            assert sum(math.dist(a, b) for a, b in itertools.pairwise(path)) > 2.0
            estop = make(sdk.ROS2Publisher, "/estop", "std_msgs/msg/Bool")
            wait_until(lambda: estop.publish(data=True) or seen["driver"][-1].mode == "estopped", "stop")
        assert recorder.stop(60.0) == 0
    keys = {recorded.key for recorded in open_recording(record).messages()}
    assert {"agilo/odom", "agilo/cmd_vel", "exec/tick", "estop"} <= keys
    assert not [key for key in keys if "RIHS01" in key], "recordings keep the plain keys"
    verified = subprocess.run(tailor("verify", str(record)), capture_output=True, text=True, timeout=300)
    assert (verified.returncode, "equal" in verified.stdout) == (0, True), verified.stdout + verified.stderr
