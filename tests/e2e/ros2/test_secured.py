"""On a secured bus the keys of rmw_zenoh let nobody do more than the plain ones, and the graph is seen by all."""

import time

import pytest

from tailor.runtime.bus.attachment import Origin
from tailor.runtime.bus.opening import open_client, open_local_router
from tailor.runtime.bus.ros_action.server import GoalAction
from tailor.schemas import codec
from tailor.schemas.messages import EStop, Odometry, VelocityCommand
from tailor.schemas.ros2.action import achieve_goal
from tailor.schemas.ros2.graph import Kind, parsed_token
from tailor.schemas.ros2.profiles import KeyProfile, ros_topic
from tailor.schemas.topics import TOPICS
from tests.support.bus_system import free_endpoint
from tests.support.patience import wait_until
from tests.support.ros2.action_client import send_request

KEYS = KeyProfile("rmw_zenoh", 0)
COMMAND = VelocityCommand(0, 0.5, 0.0)


@pytest.fixture(scope="module")
def bus():
    codec.prime()
    endpoint = free_endpoint()
    with open_local_router(endpoint, keys=KEYS):
        yield endpoint


def announced(session):
    replies = session._zenoh.liveliness().get("@ros2_lv/0/**", timeout=2.0)
    tokens = [parsed_token(str(reply.ok.key_expr)) for reply in replies if reply.ok is not None]
    return {(token.kind, token.node, token.what.name if token.what else "") for token in tokens}


def test_clients_take_the_profile_of_the_bus(bus):
    with open_client(bus) as session:
        assert session.keys == KEYS


@pytest.mark.parametrize("role", ["driver", "people", "observer", "recorder", "player", "scene"])
def test_only_the_executive_commands_under_a_key_for_ros(bus, role):
    key = ros_topic(TOPICS["cmd_vel"], "agilo").key(0)
    with (
        open_client(bus, role="driver") as driver,
        open_client(bus, role="executive") as executive,
        open_client(bus, role=role) as intruder,
    ):
        inbox, rightful = driver.inbox(["cmd_vel"], "agilo"), executive.publisher("cmd_vel", "agilo")
        wait_until(rightful.matched)
        for pattern in (key, key.replace("agilo", "*"), key.replace("0/", "*/", 1), "**"):
            intruder._zenoh.put(pattern, codec.encode(COMMAND))
        intruder.publisher("cmd_vel", "agilo").put_raw(codec.encode(COMMAND), Origin(1, 0, intruder.sender))
        time.sleep(0.3)
        rightful.publish(COMMAND)
        came = wait_until(inbox.drain)
        assert [sample.sender for sample in came] == [executive.sender]


def test_people_stop_and_others_do_not(bus):
    with (
        open_client(bus, role="driver") as driver,
        open_client(bus, role="people") as people,
        open_client(bus, role="observer") as observer,
    ):
        inbox = driver.inbox(["estop"], "agilo")
        publishers = [session.publisher("estop", "") for session in (observer, people)]
        wait_until(publishers[1].matched)
        for publisher in publishers:
            publisher.publish(EStop(True))
        assert [sample.sender for sample in wait_until(inbox.drain)] == [people.sender]


@pytest.mark.parametrize("role", ["observer", "driver", "player"])
def test_people_send_goals_by_the_action_and_others_do_not(bus, role):
    part = achieve_goal().send_goal
    with (
        open_client(bus, role="executive") as executive,
        open_client(bus, role="people") as people,
        open_client(bus, role=role) as other,
    ):
        action = GoalAction(executive)
        with people._zenoh.declare_querier(part.key(0)) as querier:
            wait_until(lambda: querier.matching_status.matching, "a server")
        for session, goal in ((other, "(theirs)"), (people, "(ours)")):
            session._zenoh.get(part.key(0), payload=send_request(b"1" * 16, goal))
        assert wait_until(action.receive).text == "(ours)"


def test_a_role_is_announced_as_what_it_may_be_and_everybody_sees_it(bus):
    with (
        open_client(bus, role="driver") as driver,
        open_client(bus, role="observer") as observer,
        open_client(bus, role="recorder") as recorder,
    ):
        publisher = driver.publisher("odom", "agilo")
        recorder.publisher("odom", "agilo")  # not its right
        observer.inbox(["odom"], "agilo")
        expected = {
            (Kind.NODE, "tailor_driver", ""),
            (Kind.PUBLISHER, "tailor_driver", "agilo/odom"),
            (Kind.NODE, "tailor_observer", ""),
            (Kind.SUBSCRIPTION, "tailor_observer", "agilo/odom"),
            (Kind.NODE, "tailor_recorder", ""),
        }
        for session in (observer, driver):  # tokens reach each by itself, and one after another
            wait_until(lambda: len(announced(session)) >= len(expected), "tokens")  # noqa: B023
            assert announced(session) == expected
        inbox = observer.inbox(["odom"], "agilo")
        wait_until(publisher.matched)
        publisher.publish(Odometry(0, 1.0, 2.0, 0.5, 0.1, 0.2))
        assert wait_until(inbox.drain)[0].sender == driver.sender
