"""A node of zenoh-ros2-sdk at a whole running system: it gives a goal, watches the robot drive there, and stops it."""

import itertools
import math

import pytest

from tailor.runtime.bus.opening import open_client
from tailor.schemas.ros2.profiles import KeyProfile
from tests.support.bus_system import accepts, free_endpoint, started
from tests.support.patience import wait_until

sdk = pytest.importorskip("zenoh_ros2_sdk")
node = pytest.importorskip("tests.support.ros2.sdk")
LONG_S = 400.0  # the scenario takes 20 s on a quiet machine


@pytest.mark.slow
def test_it_gives_a_goal_watches_and_stops_the_robot(tmp_path):
    endpoint, record = free_endpoint(), tmp_path / "run.mcap"
    with started() as start:
        flags = ("--scenario", "waypoints", "--record", record, "--security", "open", "--profile", "rmw_zenoh")
        start("tailor.tools.main", "up", "soccer", *flags, "--connect", endpoint)
        wait_until(lambda: accepts(endpoint), "bus")
        with node.sdk_node(endpoint, tmp_path / "definitions") as make:
            seen = {name: [] for name in ("odom", "tf", "scene", "status", "driver")}
            make(sdk.ROS2Subscriber, "/agilo/odom", "nav_msgs/msg/Odometry", seen["odom"].append)
            make(sdk.ROS2Subscriber, "/tf", "tf2_msgs/msg/TFMessage", seen["tf"].append)
            make(sdk.ROS2Subscriber, "/agilo/scene", "visualization_msgs/msg/MarkerArray", seen["scene"].append)
            make(sdk.ROS2Subscriber, "/exec/status", "tailor_msgs/msg/ExecStatus", seen["status"].append)
            make(sdk.ROS2Subscriber, "/agilo/driver", "tailor_msgs/msg/DriverState", seen["driver"].append)
            results = lambda: [status.result for status in seen["status"]]  # noqa: E731
            wait_until(lambda: "achieved" in results(), "first goal", LONG_S)
            path = [(each.pose.pose.position.x, each.pose.pose.position.y) for each in seen["odom"]]
            assert sum(math.dist(a, b) for a, b in itertools.pairwise(path)) > 2.0
            assert seen["tf"]
            assert seen["scene"]

            client = make(sdk.ROS2ServiceClient, "/exec/set_goal", "tailor_msgs/srv/SetGoal", timeout=60.0)
            refused = client.call(goal="(nonsense")
            assert (refused.accepted, bool(refused.message)) == (False, True)
            del seen["status"][:]
            assert client.call(goal="").accepted
            wait_until(lambda: "" in results(), "second goal", LONG_S)

            estop = make(sdk.ROS2Publisher, "/estop", "std_msgs/msg/Bool")
            wait_until(lambda: estop.publish(data=True) or seen["driver"][-1].mode == "estopped", "stop")
        with open_client(endpoint, role="observer", keys=KeyProfile("rmw_zenoh")) as session:
            assert session.keys.profile == "rmw_zenoh"
    assert record.exists()
