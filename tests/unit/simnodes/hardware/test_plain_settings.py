"""The description of a robot with plain topics: what is wrong in it is one line, and what its keys become."""

import pytest

from tailor.schemas.errors import UsageError
from tailor.schemas.ros2.plain import frame_in, twist_bytes
from tailor.schemas.typesystem import from_bytes
from tailor.simnodes.hardware.plain_keys import address, named
from tailor.simnodes.hardware.plain_settings import RobotBus, read_plain_settings

WRONG = {
    "": "robot is missing",
    'robot = "r"\nrate_hz = 500': "rate_hz is 500, expected 0.1 to 100",
    'robot = "r"\nrate_hz = 1e-310': "rate_hz is 1e-310, expected 0.1 to 100",
    'robot = "r"\nrate_hz = nan': "rate_hz is nan, expected 0.1 to 100",
    'robot = "r"\n[pose]\nrate_hz = 0': "pose.rate_hz is 0, expected 0.1 to 100",
    'robot = "r"\ncommand = "joy"': "'command' is 'joy', expected one of: twist, twist_stamped",
    'robot = "r"\n[topic]\nodom = "o"': "unknown key 'topic'",
    'robot = "r"\n[topics]\npose = ""': "expected a localiser, or pose.start",
    'robot = "r"\n[topics]\nodom = ""': "expected a name each",
    'robot = "r"\n[pose]\nstart = [1.0]': "expected x, y and phi",
    'robot = "r"\n[pose]\nstart = [1e16, 0, 0]': "expected x, y and phi, of at most 1e+06",
    'robot = "r"\n[pose]\nstart = [0, 0, 90]': "pose.start: phi is 90, expected radians, from -6.28 to 6.28",
    'robot = "r"\n[pose]\nstart = [nan, 0, 0]': "expected x, y and phi",
    'robot = "r"\n[pose]\ndrift_per_m = -1.0': "pose.drift_per_m is -1, expected 0 to 1",
    'robot = "r"\n[pose]\nmax_std_m = 0.0': "pose.max_std_m is 0, expected more than 0, up to 1000",
    'robot = "r"\n[bus]\nprofile = "dds"': "expected one of: plain, rmw_zenoh",
    'robot = "r"\n[bus]\ndomain_id = 233': "bus.domain_id is 233, expected 0 to 232",
    'robot = "r"\n[topics]\ncmd_vel = "**"': "topics.cmd_vel is '**', expected a name of ROS 2 such as /base/cmd_vel",
    'robot = "r"\n[topics]\nodom = "base//odom"': "topics.odom is 'base//odom', expected a name of ROS 2",
    'robot = "r"\n[topics]\nodom = "/base"\ncmd_vel = "base"': "topics: 'base' is named twice",
    'robot = "r"\n[topics]\npose = "/"': "topics.pose is '/', expected a name of ROS 2",
    f'robot = "r"\n[topics]\nodom = "{"o" * 248}"': "topics.odom has 248 characters, expected at most 247",
    "robot = ": "not TOML",
    "robot = " + "[" * 5000: "nested too deeply, expected the description of a robot",
    f'robot = "r"\n[pose]\nstart = [1{"0" * 400}, 0, 0]': "expected a number of at most 64 bits",
}


@pytest.mark.parametrize("text", WRONG, ids=range(len(WRONG)))
def test_a_wrong_description_is_refused_in_one_line_that_names_file_and_key(tmp_path, text):
    file = tmp_path / "robot.toml"
    file.write_text(text)
    with pytest.raises(UsageError) as refused:
        read_plain_settings(str(file))
    assert str(refused.value).startswith(f"{file}: ")
    assert WRONG[text] in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_turtlebot_needs_three_lines(tmp_path):
    file = tmp_path / "robot.toml"
    file.write_text('robot = "courier"\n[bus]\nconnect = "tcp/192.168.0.7:7447"\n')
    settings = read_plain_settings(str(file))
    assert (settings.command, settings.topics.cmd_vel, settings.topics.pose) == (
        "twist_stamped",
        "cmd_vel",
        "amcl_pose",
    )


def test_keys_of_both_profiles():
    assert address(RobotBus(), named("/base/cmd_vel", "geometry_msgs/msg/Twist")) == (
        "base/cmd_vel",
        "application/cdr;geometry_msgs/msg/Twist",
    )
    key, encoding = address(RobotBus(profile="rmw_zenoh", domain_id=3), named("/odom", "nav_msgs/msg/Odometry"))
    assert key.startswith("3/odom/nav_msgs::msg::dds_::Odometry_/RIHS01_3cc97dc7")
    assert encoding == "application/cdr"


def test_bytes_of_a_twist_are_those_of_ros():
    plain = twist_bytes(0.5, -0.25)
    assert len(plain) == 4 + 48
    value, left = from_bytes(plain, "geometry_msgs/msg/Twist")
    assert (value.linear.x, value.angular.z, left) == (0.5, -0.25, 0)
    stamped = twist_bytes(0.5, -0.25, (1_500_000_000, "base_link"))
    value, left = from_bytes(stamped, "geometry_msgs/msg/TwistStamped")
    assert (value.twist.linear.x, value.twist.angular.z, value.header.stamp.sec, left) == (0.5, -0.25, 1, 0)
    assert frame_in(stamped) == "base_link"
    assert frame_in(b"\0\1\0\0") == ""
