"""A node of zenoh-ros2-sdk, which shares no code with us, and a session of ours: each finds and hears the other."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tailor.runtime.bus.opening import open_client, open_router
from tailor.runtime.bus.ros_action.server import GoalAction
from tailor.schemas import codec
from tailor.schemas import messages as m
from tailor.schemas.ros2.action import achieve_goal
from tailor.schemas.ros2.action_messages import GoalState
from tailor.schemas.ros2.profiles import KeyProfile, ros_topic
from tailor.schemas.topics import TOPICS
from tests.support.bus_system import free_endpoint
from tests.support.patience import wait_until
from tests.support.ros2.routing import goal_client, stranger, wait_for_subscriber

sdk = pytest.importorskip("zenoh_ros2_sdk")
node = pytest.importorskip("tests.support.ros2.sdk")
KEYS = KeyProfile("rmw_zenoh", 0)
ODOMETRY = m.Odometry(1_500_000_000, 1.0, 2.0, 0.5, 0.1, 0.2)


@pytest.fixture(scope="module")
def endpoint():
    codec.prime()
    endpoint = free_endpoint()
    with open_router(endpoint):
        yield endpoint


@pytest.fixture(scope="module")
def ros(endpoint, tmp_path_factory):
    """The node's maker, and our session, on one router."""
    with (
        open_client(endpoint, keys=KEYS, role="executive") as session,
        node.sdk_node(endpoint, tmp_path_factory.mktemp("definitions")) as make,
    ):
        yield make, session


def test_it_reads_our_odometry(ros):
    make, session = ros
    received = []
    make(sdk.ROS2Subscriber, "/agilo/odom", "nav_msgs/msg/Odometry", received.append)
    publisher = session.publisher("odom", "agilo")
    wait_until(publisher.matched)
    publisher.publish(ODOMETRY)
    (ros_odometry,) = wait_until(lambda: received)
    assert (ros_odometry.pose.pose.position.x, ros_odometry.twist.twist.angular.z) == (1.0, 0.2)
    assert (ros_odometry.header.stamp.sec, ros_odometry.child_frame_id) == (1, "base_link")


def test_it_reads_transforms_and_markers(ros):
    make, session = ros
    received = {"tf": [], "agilo/scene": []}
    make(sdk.ROS2Subscriber, "/tf", "tf2_msgs/msg/TFMessage", received["tf"].append)
    make(sdk.ROS2Subscriber, "/agilo/scene", "visualization_msgs/msg/MarkerArray", received["agilo/scene"].append)
    frames, shapes = session.publisher("transforms", "agilo"), session.publisher("scene", "agilo")
    wait_until(lambda: frames.matched() and shapes.matched())
    frames.publish(m.FrameTransforms(5, (m.FrameTransform("map", "odom", 1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0),)))
    turn, size, colour = (0.0, 0.0, 0.0, 1.0), (0.2, 0.2, 0.2), (1.0, 0.0, 0.0, 1.0)
    shapes.publish(m.SceneShapes(5, (m.Shape("ball", 2, "map", 1.0, 0.0, 0.0, *turn, *size, *colour, 0.5),)))
    wait_until(lambda: all(received.values()))
    assert received["tf"][0].transforms[0].child_frame_id == "odom"
    assert [marker.ns for marker in received["agilo/scene"][0].markers] == ["ball"]


def test_we_read_its_pose(ros, endpoint):
    make, session = ros
    inbox = session.inbox(["pose"], "agilo")
    wait_for_subscriber(endpoint, ros_topic(TOPICS["pose"], "agilo").key(KEYS.domain))
    publisher = make(sdk.ROS2Publisher, "/agilo/pose", "geometry_msgs/msg/PoseWithCovarianceStamped")
    publish_pose(publisher, 1.5, -2.0)
    (sample,) = wait_until(inbox.drain)
    assert sample.message == m.PoseEstimate(3_000_000_000, 1.5, -2.0, 0.0, 0.25, 0.25, 0.25)
    assert (sample.key, len(sample.sender), inbox.rejected) == ("agilo/pose", 32, {})


def publish_pose(publisher, x, y):
    import numpy as np

    stamp = node.value("builtin_interfaces/msg/Time", sec=3, nanosec=0)
    point = node.value("geometry_msgs/msg/Point", x=x, y=y, z=0.0)
    turn = node.value("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=0.0, w=1.0)
    pose = node.value("geometry_msgs/msg/Pose", position=point, orientation=turn)
    spread = node.value("geometry_msgs/msg/PoseWithCovariance", pose=pose, covariance=np.eye(6).ravel() / 4)
    publisher.publish(header=node.value("std_msgs/msg/Header", stamp=stamp, frame_id="map"), pose=spread)


def test_its_estop_is_latched(ros, endpoint):
    make, session = ros
    inbox = session.inbox(["estop"], "agilo")
    wait_for_subscriber(endpoint, ros_topic(TOPICS["estop"], "agilo").key(KEYS.domain))
    make(sdk.ROS2Publisher, "/estop", "std_msgs/msg/Bool").publish(data=True)
    (sample,) = wait_until(inbox.drain)
    assert sample.message == m.EStop(True)


@cache
def goal_server(session):
    return session.service_server("exec/goal")


@pytest.mark.parametrize(("goal", "answer"), [("(atball pos3)", (True, "accepted")), ("(bad", (False, "no goal"))])
def test_its_call_of_the_service_is_answered(ros, endpoint, goal, answer):
    make, session = ros
    server = goal_server(session)
    with goal_client(endpoint, KEYS.domain):
        pass  # the router knows the server
    client = make(sdk.ROS2ServiceClient, "/exec/set_goal", "tailor_msgs/srv/SetGoal")
    answered = []
    client.call_async(answered.append, goal=goal)
    request = wait_until(server.poll)
    assert request.text == goal
    request.accept() if answer[0] else request.refuse("no goal")
    (response,) = wait_until(lambda: answered)
    assert (response.accepted, response.message) == answer


def test_it_pursues_a_goal_by_the_action(ros, endpoint):
    """The definitions are flat: CDR has no bytes for nesting. Only the hashes are ours."""
    make, session = ros
    action, parts, goal_id = GoalAction(session), achieve_goal(), b"\7" * 16
    heard = []
    make(sdk.ROS2Subscriber, f"/{parts.status.name}", parts.status.type, heard.append)

    def called(part, request, response, **fields):
        with stranger(endpoint) as other, other.declare_querier(part.key(KEYS.domain)) as querier:
            wait_until(lambda: querier.matching_status.matching, "a server")
        request = f"uint8[16] goal_id\n{request}"
        client = make(sdk.ROS2ServiceClient, f"/{part.name}", part.type, request, response, type_hash=part.hash)
        answered = []
        client.call_async(answered.append, goal_id=np.frombuffer(goal_id, np.uint8), **fields)
        return answered

    sent = called(parts.send_goal, "string goal", "bool accepted\nbuiltin_interfaces/Time stamp", goal="(visited a)")
    request = wait_until(action.receive)
    assert request.text == "(visited a)"
    request.accept()
    assert wait_until(lambda: sent)[0].accepted
    fields = "int8 status\nstring result\nstring reason\nstring detail\nfloat64 duration_s"
    result = called(parts.get_result, "", fields)
    wait_until(lambda: action.answer() or action._waiting, "the request for the result")
    status = m.ExecStatus(0, 1, "EXECUTING", "", "line", "(visited a)", "", "slide", 0, 0.0, 0.0)
    action.report(status)
    action.report(replace(status, mode="READY", result="achieved"))
    (answer,) = wait_until(lambda: result)
    assert (answer.status, answer.result) == (GoalState.SUCCEEDED, "achieved")
    wait_until(lambda: len(heard) == 2, "the states")
    assert [each.status_list[0].status for each in heard] == [GoalState.EXECUTING, GoalState.SUCCEEDED]


def test_it_lists_our_topics_and_service_while_we_live(ros):
    from zenoh_ros2_sdk import discovery

    _, session = ros
    session.publisher("cmd_vel", "robot7")
    goal_server(session)
    port = node.port()

    def listed():
        return dict(discovery.get_topic_names_and_types(domain_id=0, router_port=port))

    wait_until(lambda: "/robot7/cmd_vel" in listed())
    assert listed()["/robot7/cmd_vel"] == ["geometry_msgs/msg/TwistStamped"]
    services = dict(discovery.get_service_names_and_types(domain_id=0, router_port=port))
    assert services["/exec/set_goal"] == ["tailor_msgs/srv/SetGoal"]
    (publisher,) = discovery.get_topic_info("/robot7/cmd_vel", domain_id=0, router_port=port, verbose=True).publishers
    assert (publisher.node_name, publisher.qos) == ("tailor_executive", "::,10:,:,:,,")
