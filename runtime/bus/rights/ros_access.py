"""What each role may announce in the graph of ROS 2, and the keys of services under both key profiles.

A session announces only what it may publish, call or serve, so nobody pretends to be the publisher of a command.
"""

from __future__ import annotations

from collections.abc import Iterable

from tailor.schemas.ros2.action import achieve_goal
from tailor.schemas.ros2.graph import ADMIN_SPACE, Kind, Named, dds_name, mangled
from tailor.schemas.ros2.profiles import ros_topic
from tailor.schemas.ros2.service import set_goal
from tailor.schemas.services import Service
from tailor.schemas.topics import Topic

ALL_TOKENS = [f"{ADMIN_SPACE}/**"]
_OF_ANY_SESSION = f"{ADMIN_SPACE}/*/*/*/*"  # domain, session, node, entity
_NODE = f"{_OF_ANY_SESSION}/{Kind.NODE.value}/*/*/*"  # enclave, namespace, name
_SUBSCRIPTION = f"{_OF_ANY_SESSION}/{Kind.SUBSCRIPTION.value}/**"


def service_keys(services: Iterable[Service]) -> list[str]:
    """Keys of services, for ROS 2 nodes as well."""
    services = list(services)
    return [*(each.pattern for each in services), *(named.key("*") for named in _named(services))]


def action_topic_keys(served: Iterable[Service]) -> list[str]:
    """Keys of the topics of the action that pursues a goal, for who serves it."""
    return [named.key("*") for named in _action_topics(served)]


def tokens(published: Iterable[Topic], called: Iterable[Service], served: Iterable[Service]) -> list[str]:
    """Patterns of the tokens of a role: any node and subscription, and what it publishes, calls and serves."""
    return [
        _NODE,
        _SUBSCRIPTION,
        *sorted({_pattern(Kind.PUBLISHER, ros_topic(topic, "*")) for topic in published}),
        *(_pattern(Kind.PUBLISHER, named) for named in _action_topics(served)),
        *(_pattern(Kind.CLIENT, named) for named in _named(called)),
        *(_pattern(Kind.SERVICE, named) for named in _named(served)),
    ]


def _named(services: Iterable[Service]) -> list[Named]:
    """The services that ROS 2 knows, all of them for goals: one sets a goal, three belong to the action."""
    return [set_goal(), *achieve_goal().services] if _for_goals(services) else []


def _action_topics(served: Iterable[Service]) -> tuple[Named, ...]:
    return achieve_goal().topics if _for_goals(served) else ()


def _for_goals(services: Iterable[Service]) -> bool:
    return any(service.ros_name for service in services)


def _pattern(kind: Kind, what: Named) -> str:
    name = mangled("/" + what.name).replace("*", "$*")  # $* matches inside one part of a key
    return f"{_OF_ANY_SESSION}/{kind.value}/*/*/*/{name}/{dds_name(what.type)}/{what.hash}/*"
