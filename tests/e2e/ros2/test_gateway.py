"""A node of ROS 2 that comes by TCP, through a gateway process, has the rights of its password under its own keys."""

import itertools
from contextlib import contextmanager

import pytest
import zenoh

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.opening import open_client, open_local_router
from tailor.runtime.bus.rights.credentials import Password
from tailor.runtime.bus.rights.run_folder import run_folder
from tailor.runtime.bus.zenoh_config import client
from tailor.schemas import codec
from tailor.schemas.messages import EStop, Odometry, VelocityCommand
from tailor.schemas.ros2.graph import Kind, parsed_token
from tailor.schemas.ros2.profiles import KeyProfile, ros_topic
from tailor.schemas.topics import TOPICS
from tests.support.bus_system import accepts, free_endpoint, started
from tests.support.patience import wait_until

KEYS = KeyProfile("rmw_zenoh", 0)
ODOMETRY, COMMAND = Odometry(0, 1.0, 2.0, 0.5, 0.1, 0.2), VelocityCommand(0, 0.5, 0.0)
ODOM, CMD_VEL, ESTOP = (ros_topic(TOPICS[name], "agilo").key(0) for name in ("odom", "cmd_vel", "estop"))


@pytest.fixture(scope="module")
def bus():
    codec.prime()
    endpoint = free_endpoint()
    with open_local_router(endpoint, keys=KEYS), started() as start:
        start("tailor.tools.main", "gateway", "--connect", endpoint)
        wait_until(lambda: accepts(endpoint), "gateway")
        yield endpoint


@contextmanager
def by_tcp(endpoint, role):
    """A session of zenoh itself over TCP, with the password of a role."""
    password = Password(role, run_folder(endpoint).password(role))
    with zenoh.open(zenoh.Config.from_json5(client([endpoint], password=password))) as session:
        yield session


def put(session, key, message, number):
    session.put(key, codec.encode(message), attachment=pack(Origin(number, 0, "ab" * 16)))


def test_it_reads_odometry_and_sees_who_publishes_it(bus):
    with open_client(bus, role="driver") as driver, by_tcp(bus, "observer") as node:
        received, publisher = node.declare_subscriber(ODOM), driver.publisher("odom", "agilo")
        sample = wait_until(lambda: publisher.publish(ODOMETRY) and received.try_recv(), "odometry", 20.0)
        assert sample.payload.to_bytes() == codec.encode(ODOMETRY)
        tokens = node.liveliness().get("@ros2_lv/0/**", timeout=5.0)
        announced = [parsed_token(str(reply.ok.key_expr)) for reply in tokens if reply.ok is not None]
        assert (Kind.PUBLISHER, "agilo/odom") in [(each.kind, each.what.name) for each in announced if each.what]


def test_people_stop_from_there_and_do_not_command(bus):
    with open_client(bus, role="driver") as driver, by_tcp(bus, "people") as people, by_tcp(bus, "executive") as other:
        inbox = driver.inbox(["cmd_vel", "estop"], "agilo", newest_only=False)
        numbers = itertools.count(1)
        wait_until(
            lambda: put(other, CMD_VEL, COMMAND, next(numbers)) or inbox.drain(), "command by its password", 20.0
        )
        put(people, CMD_VEL, COMMAND, 1000)
        put(people, ESTOP, EStop(True), 1001)
        heard = []
        wait_until(
            lambda: heard.extend(inbox.drain()) or any(isinstance(each.message, EStop) for each in heard), "stop"
        )
        assert 1000 not in [each.sequence for each in heard]
