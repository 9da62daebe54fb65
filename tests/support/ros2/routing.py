"""Waits for a router: what is put or requested before it knows who listens reaches nobody."""

from contextlib import contextmanager

import zenoh

from tailor.runtime.bus.zenoh_config import client
from tailor.schemas.ros2 import service
from tests.support.patience import wait_until


@contextmanager
def stranger(endpoint):
    """A session of zenoh as others open it: keys, bytes and attachments, nothing of ours."""
    with zenoh.open(zenoh.Config.from_json5(client([endpoint]))) as session:
        yield session


def wait_for_subscriber(endpoint, key):
    """Returns as soon as the router has a subscriber to the key from anybody."""
    with stranger(endpoint) as session, session.declare_publisher(key) as publisher:
        wait_until(lambda: publisher.matching_status.matching, f"a subscriber to {key}")


@contextmanager
def goal_client(endpoint, domain):
    """A querier of the goal's service under its key of rmw_zenoh, as soon as the router has a server of it."""
    with stranger(endpoint) as session, session.declare_querier(service.set_goal().key(domain)) as querier:
        wait_until(lambda: querier.matching_status.matching, "a server of goals")
        yield querier
