"""A node of zenoh-ros2-sdk: it keeps one session and one registry a process, and reads definitions from a folder."""

from contextlib import contextmanager

from zenoh_ros2_sdk import message_registry
from zenoh_ros2_sdk.session import ZenohSession

from tests.support.ros2.definitions import write_definitions


@contextmanager
def sdk_node(endpoint, folder):
    """Yields make(kind, name, type, ...), which makes its publishers, subscribers and clients on the bus."""
    write_definitions(folder)
    message_registry._registry = message_registry.MessageRegistry(str(folder))  # or it recalls types of another session
    port = int(endpoint.rpartition(":")[2])
    session = ZenohSession.get_instance("127.0.0.1", port)
    made = []

    def make(kind, *arguments, **more):
        made.append(kind(*arguments, domain_id=0, router_port=port, **more))
        return made[-1]

    try:
        yield make
    finally:
        for each in made:
            each.close()
        session.session.close()
        ZenohSession._instance = None


def value(name, **fields):
    """A message of a type that a publisher or subscriber has registered."""
    return ZenohSession.get_instance().store.types[name](**fields)


def port():
    """Port of the node's router."""
    return ZenohSession.get_instance().router_port
