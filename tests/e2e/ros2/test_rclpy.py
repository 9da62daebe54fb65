"""Real ROS 2: an unmodified executive drives a robot in rclpy behind a bridge of bytes, and ROS 2 reads recordings.

Skipped without the extra `ros` (`pip install -e '.[ros]'`, Python 3.11).
"""

import subprocess
import sys
from importlib.util import find_spec

import pytest

from tailor.executive import domains
from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.codec import decode
from tailor.schemas.ros2.action_messages import GoalInfo, GoalState, states_message
from tailor.schemas.typesystem import message_types, ros_type, type_of
from tests.support.bus_system import ROOT, bus_system
from tests.support.robots.driving import achieved, arm, executive_on, ready

pytestmark = pytest.mark.skipif(find_spec("rclpy") is None, reason="no rclpy: pip install -e '.[ros]' (Python 3.11)")
IN_ROS = "tests.support.ros2.in_ros"
STANDARD = ("geometry_msgs", "nav_msgs", "sensor_msgs", "std_msgs", "visualization_msgs")  # of the wheels


@pytest.mark.slow
def test_a_robot_in_rclpy_is_driven_to_its_goal(tmp_path):
    start_pose = domains.seeded_scenario("soccer", "waypoints", 0)[1]
    file = tmp_path / "robot.toml"
    with bus_system() as (session, endpoint, start), bus_system() as (_, robots, start_robot):
        start_robot(IN_ROS, "tests.support.ros2.rclpy_robot")
        links = ("in:cmd_vel=geometry_msgs/msg/TwistStamped", "out:odom=nav_msgs/msg/Odometry")
        start_robot(IN_ROS, "tests.support.ros2.byte_bridge", robots, *links)
        pose = [start_pose[name] for name in ("x", "y", "phi")]
        file.write_text(f'robot = "agilo"\n[bus]\nconnect = "{robots}"\n[topics]\npose = ""\n[pose]\nstart = {pose}\n')
        start("tailor.tools.main", "driver", file, "--connect", endpoint)
        ready(session, "agilo")
        executive = executive_on(start, endpoint, "soccer", "waypoints")
        arm(session, "agilo")
        assert achieved(executive)


def test_ros_reads_the_recorded_messages_and_writes_the_same_values():
    golden = ROOT / "tests" / "data" / "golden" / "soccer-approach-dribble.mcap"
    known = {ros_type(kind) for kind in message_types() if ros_type(kind).split("/")[0] in STANDARD}
    recorded = [each for each in open_recording(golden).messages() if each.ros_type in known]
    assert {each.ros_type for each in recorded} >= {"geometry_msgs/msg/TwistStamped", "nav_msgs/msg/Odometry"}
    written = written_by_ros((each.ros_type, each.data) for each in recorded)
    for each, data in zip(recorded, written, strict=True):
        kind = type_of(each.ros_type)
        assert decode(kind, data) == decode(kind, each.data)


def test_ros_reads_the_states_of_an_actions_goals_and_writes_the_same_bytes():
    goals = [(GoalInfo(bytes(range(16)), 1_700_000_000_000_000_123), state) for state in GoalState]
    states = states_message(goals)
    assert written_by_ros([("action_msgs/msg/GoalStatusArray", states)]) == [states]


def written_by_ros(messages):
    """What ROS 2 writes of each message that it has read."""
    lines = "".join(f"{kind} {data.hex()}\n" for kind, data in messages)
    command = [sys.executable, "-m", IN_ROS, "tests.support.ros2.read_with_rclpy"]
    done = subprocess.run(command, input=lines, capture_output=True, text=True, check=True, cwd=ROOT)
    return [bytes.fromhex(line) for line in done.stdout.split()]
