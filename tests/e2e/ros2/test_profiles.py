"""Sessions under the keys of rmw_zenoh on a real router: data, tokens, copies, services, recordings."""

import time

import pytest

from tailor.runtime.bus.attachment import Origin, pack, unpack
from tailor.runtime.bus.opening import open_client
from tailor.runtime.bus.session import opened
from tailor.runtime.bus.zenoh_config import client
from tailor.schemas import codec
from tailor.schemas.messages import EStop, Odometry, VelocityCommand
from tailor.schemas.ros2 import service
from tailor.schemas.ros2.graph import Kind, parsed_token
from tailor.schemas.ros2.profiles import KeyProfile, ros_topic
from tailor.schemas.topics import TOPICS
from tests.support.patience import wait_until
from tests.support.ros2.routing import goal_client, stranger, wait_for_subscriber

ODOMETRY = Odometry(0, 1.0, 2.0, 0.5, 0.1, 0.2)
ROS, BOTH = KeyProfile("rmw_zenoh", 7), KeyProfile("both", 7)
ODOM, ESTOP = (ros_topic(TOPICS[name], "agilo").key(7) for name in ("odom", "estop"))
STRANGER = "ab" * 16


def both_matched(publisher):
    """Whether somebody listens under either key of a publisher."""
    declared = publisher._wire._publishers
    return len(declared) == 2 and all(each.matching_status.matching for each in declared)


def announced(session):
    """All tokens of the domain that the router knows."""
    replies = session.liveliness().get("@ros2_lv/7/**", timeout=2.0)
    return [parsed_token(str(reply.ok.key_expr)) for reply in replies if reply.ok is not None]


@pytest.mark.parametrize("keys", [ROS, BOTH])
def test_a_node_of_ros_and_a_session_hear_each_other(endpoint, keys):
    with open_client(endpoint, keys=keys) as ours, stranger(endpoint) as theirs:
        received = theirs.declare_subscriber(ODOM)
        publisher = ours.publisher("odom", "agilo")
        wait_until(publisher.matched)  # by them: we do not listen yet
        inbox = ours.inbox(["odom"], "agilo", newest_only=False)
        publisher.publish(ODOMETRY)
        sample = wait_until(received.try_recv)
        assert (sample.payload.to_bytes(), str(sample.key_expr)) == (codec.encode(ODOMETRY), ODOM)
        assert unpack(sample.attachment.to_bytes()).sender == ours.sender
        theirs.put(ODOM, codec.encode(ODOMETRY), attachment=pack(Origin(5, 0, STRANGER)))
        came = []
        wait_until(lambda: came.extend(inbox.drain()) or len(came) >= 2)
        assert {(each.key, each.sender, each.sequence) for each in came} == {
            ("agilo/odom", STRANGER, 5),
            ("agilo/odom", ours.sender, 1),
        }
        assert inbox.rejected == {}


def test_under_both_profiles_each_message_arrives_once(endpoint):
    with open_client(endpoint, keys=BOTH) as a, open_client(endpoint, keys=BOTH) as b:
        publisher, inbox = a.publisher("cmd_vel", "agilo"), b.inbox(["cmd_vel"], "agilo")
        queue, subscription = b.subscribe_all("**")
        wait_until(lambda: both_matched(publisher))
        for number in range(5):
            publisher.publish(VelocityCommand(number, 0.1, 0.0))
        came = []
        wait_until(lambda: came.extend(inbox.drain()) or len(came) >= 5)
        time.sleep(0.2)
        assert [each.sequence for each in (*came, *inbox.drain())] == [1, 2, 3, 4, 5]
        assert [(raw.key, raw.encoding) for raw in queue.drain()] == [
            ("agilo/cmd_vel", "application/cdr;geometry_msgs/msg/TwistStamped")
        ] * 5
        subscription.undeclare()


def test_a_wildcard_put_under_a_key_for_ros_is_not_accepted_as_a_command(endpoint):
    with open_client(endpoint, keys=ROS) as ours, stranger(endpoint) as theirs:
        inbox = ours.inbox(["cmd_vel"], "agilo")
        key = ros_topic(TOPICS["cmd_vel"], "agilo").key(7)
        wait_for_subscriber(endpoint, key)
        theirs.put(key.replace("agilo", "*"), codec.encode(VelocityCommand(0, 0.5, 0.0)))
        wait_until(lambda: inbox.drain() or inbox.rejected, "wildcard put")
        assert inbox.rejected == {("agilo/cmd_vel", "other key"): 1}


@pytest.mark.parametrize("profile", ["plain", "rmw_zenoh", "both"])
def test_an_estop_is_heard_whatever_the_profiles_of_either_side(endpoint, profile):
    keys = KeyProfile(profile, 7)
    with open_client(endpoint, keys=keys) as ours, stranger(endpoint) as theirs:
        heard = [theirs.declare_subscriber(key) for key in ("estop", ESTOP)]
        publisher = ours.publisher("estop", "")
        wait_until(lambda: both_matched(publisher))
        inbox = ours.inbox(["estop"], "agilo")
        publisher.publish(EStop(True))
        assert [wait_until(each.try_recv).payload.to_bytes() for each in heard] == [codec.encode(EStop(True))] * 2
        assert [each.message for each in wait_until(inbox.drain)] == [EStop(True)]
        for key in ("estop", ESTOP):
            theirs.put(key, codec.encode(EStop(True)))
            assert [each.message for each in wait_until(inbox.drain)] == [EStop(True)]


def test_what_a_session_declares_appears_in_the_graph_and_disappears_with_it(endpoint):
    with stranger(endpoint) as theirs:
        with open_client(endpoint, keys=ROS, role="executive") as ours:
            ours.inbox(["odom", "odom"], "agilo")
            ours.publisher("cmd_vel", "agilo")
            ours.service_server("exec/goal")
            wait_until(lambda: len(announced(theirs)) >= 4, "four tokens")
            names = [(each.kind, each.what.name if each.what else each.node) for each in announced(theirs)]
            assert len(names) == 4
            assert set(names) == {
                (Kind.NODE, "tailor_executive"),
                (Kind.SUBSCRIPTION, "agilo/odom"),
                (Kind.PUBLISHER, "agilo/cmd_vel"),
                (Kind.SERVICE, "exec/set_goal"),
            }
        wait_until(lambda: announced(theirs) == [], "an empty graph")


def test_the_plain_profile_is_not_part_of_the_graph(endpoint):
    with stranger(endpoint) as theirs, open_client(endpoint, role="executive") as ours:
        ours.publisher("cmd_vel", "agilo")
        ours.inbox(["odom", "estop"], "agilo")
        ours.service_server("exec/goal")
        time.sleep(0.3)
        assert announced(theirs) == []


def test_a_goal_of_ros_is_answered_to_its_client(endpoint):
    with open_client(endpoint, keys=ROS) as ours:
        server = ours.service_server("exec/goal")
        with goal_client(endpoint, 7) as theirs:
            for goal, accepted in (("(good)", True), ("(bad)", False)):
                replies = theirs.get(payload=service.request(goal), attachment=pack(Origin(3, 1, STRANGER)))
                request = wait_until(server.poll)
                assert request.text == goal
                request.accept() if accepted else request.refuse("no such goal")
                reply = wait_until(replies.try_recv).ok
                expected = (True, "accepted") if accepted else (False, "no such goal")
                assert service.result_of(reply.payload.to_bytes()) == expected
                origin = unpack(reply.attachment.to_bytes())
                assert (origin.sequence, origin.sender) == (3, STRANGER)


def test_a_damaged_request_is_refused_and_the_next_one_served(endpoint):
    with open_client(endpoint, keys=ROS) as ours:
        server = ours.service_server("exec/goal")
        with goal_client(endpoint, 7) as theirs:
            replies = theirs.get(payload=b"\1")
            reply = wait_until(lambda: None if server.poll() else replies.try_recv())
        assert service.result_of(reply.ok.payload.to_bytes()) == (False, "the request is malformed")


def test_a_recorded_message_is_played_under_the_keys_of_the_profile(endpoint):
    with open_client(endpoint, keys=ROS) as ours, stranger(endpoint) as theirs:
        received = theirs.declare_subscriber(ODOM)
        player = ours.player("agilo/odom", "nav_msgs/msg/Odometry")
        wait_until(player.matched)
        player.put_raw(codec.encode(ODOMETRY), Origin(4, 9, STRANGER))
        assert unpack(wait_until(received.try_recv).attachment.to_bytes()) == Origin(4, 9, STRANGER)
        foreign = theirs.declare_subscriber("agilo/scan")
        player = ours.player("agilo/scan", "sensor_msgs/msg/LaserScan")
        wait_until(player.matched)
        player.put_raw(b"scan", Origin(1, 9, STRANGER))
        assert wait_until(foreign.try_recv).payload.to_bytes() == b"scan"


def test_another_domain_is_not_heard(endpoint):
    with open_client(endpoint, keys=KeyProfile("rmw_zenoh", 8)) as other, open_client(endpoint, keys=ROS) as ours:
        inbox, publisher = other.inbox(["odom"], "agilo"), ours.publisher("odom", "agilo")
        publisher.publish(ODOMETRY)
        time.sleep(0.3)
        assert inbox.drain() == ()
        with opened(client([endpoint])) as witness:
            assert witness.keys == KeyProfile()
