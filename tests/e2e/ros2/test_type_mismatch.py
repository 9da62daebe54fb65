"""A base that takes Twist where TwistStamped comes stands in silence; driver and check-driver name the mismatch."""

import pytest

from tailor.runtime.bus.opening import open_client
from tailor.schemas.ros2.profiles import KeyProfile
from tailor.simnodes.hardware.plain_keys import named
from tailor.simnodes.hardware.plain_robot import PlainRobot
from tailor.simnodes.hardware.plain_settings import PlainSettings, RobotBus
from tailor.tools.conformance import live_link
from tailor.tools.conformance.live_link import LiveLink, NoDriverError
from tests.support.patience import wait_until

TWIST, STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"

NOBODY = "cmd_vel: nobody takes commands there, expected the base (topics.cmd_vel)"


def fault(robot):
    """What `read` raises, as the driver publishes it."""
    try:
        robot.read()
    except ValueError as error:
        return str(error)
    return ""


@pytest.mark.parametrize(
    ("command", "taken", "setting"), [("twist", STAMPED, "twist_stamped"), ("twist_stamped", TWIST, "twist")]
)
def test_the_driver_names_it_until_the_base_takes_what_is_published(endpoint, command, taken, setting):
    robot = PlainRobot(PlainSettings("agilo", command, bus=RobotBus(endpoint, profile="rmw_zenoh")), endpoint)
    robot.open()
    try:
        assert fault(robot) == ""  # no base yet
        ours = STAMPED if taken == TWIST else TWIST
        with open_client(endpoint) as base:
            base.plain_source(named("/cmd_vel", taken).key(0))
            line = f"cmd_vel: a subscriber of {taken}, we publish {ours}; set command = '{setting}'"
            assert wait_until(lambda: fault(robot)) == line
        wait_until(lambda: fault(robot) in ("", NOBODY), "end of the base")
        with open_client(endpoint) as other_odometry:
            other_odometry.plain_publisher(named("odom", TWIST).key(0), "application/cdr")
            line = f"odom: a publisher of {TWIST}, we subscribe to nav_msgs/msg/Odometry"
            assert wait_until(lambda: fault(robot)) == line
    finally:
        robot.close()


def test_check_driver_names_a_driver_of_another_type(endpoint, monkeypatch):
    monkeypatch.setattr(live_link, "MATCH_S", 1.0)
    keys = KeyProfile("rmw_zenoh")
    with open_client(endpoint, keys=keys) as executive, open_client(endpoint) as driver:
        with pytest.raises(NoDriverError, match="no driver of agilo within 1 s"):
            LiveLink(executive, executive, "agilo", ["cmd_vel"], [])
        driver.plain_source(named("agilo/cmd_vel", TWIST).key(0))
        with pytest.raises(NoDriverError) as refused:
            LiveLink(executive, executive, "agilo", ["cmd_vel"], [])
        assert str(refused.value) == f"agilo/cmd_vel: a subscriber of {TWIST}, we publish {STAMPED}"
