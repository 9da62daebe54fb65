"""Who may publish, call and serve what on a secured bus: zenoh's rules, from the tables of topics and services.

Everything that is not allowed here is denied (an allow-list): a put on a pattern such as `agilo/*` matches no rule.
Everybody on the bus may subscribe to everything, and look at the graph of ROS 2. This module does not import zenoh.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from tailor.runtime.bus.rights.ros_access import ALL_TOKENS, action_topic_keys, service_keys, tokens
from tailor.runtime.bus.rights.run_folder import GATEWAY
from tailor.schemas.messages import EStop
from tailor.schemas.ros2.action import MAX_TOPIC_BYTES
from tailor.schemas.ros2.profiles import ros_patterns
from tailor.schemas.services import MAX_REQUEST_BYTES, ROLES, SERVICES, Role
from tailor.schemas.topics import TOPICS, Source, Topic

PEER_LIMIT_HZ = 1000.0  # e-stops of one peer; a flood brings 50 000
LOCAL_LIMIT_HZ = 5000.0  # of all peers behind one gateway together
_PUBLISHERS: dict[Source, tuple[Role, ...]] = {
    "executive": ("executive", "player"),
    "driver": ("driver", "player"),
    "simulator": ("driver", "player"),
    "scene": ("scene", "player"),
    "people": ("people",),
    "player": ("player",),
    "launcher": (),  # publishes as the router itself
}


def may_publish(topic: Topic) -> tuple[Role, ...]:
    """Roles that may publish a topic; a player of recordings drives, arms and stops no robot, and confirms no stop."""
    return tuple(role for role in _PUBLISHERS[topic.source] if topic.playable or role != "player")


def access_control(subjects: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """zenoh's `access_control`.

    Args:
      subjects: One for each role that may connect: `id` is the role (or GATEWAY), besides `usernames` or
        `cert_common_names`.
    """
    rules = [*_common_rules(), *(rule for role in ROLES for rule in _rules_of(role))]
    policies = [{"subjects": [subject["id"]], "rules": _rule_names(subject["id"], rules)} for subject in subjects]
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": rules,
        "subjects": list(subjects),
        "policies": policies,
    }


def size_limits() -> list[dict[str, Any]]:
    """zenoh's `low_pass_filter`: the largest payload of each topic, and of requests."""
    sizes = sorted({topic.max_bytes for topic in TOPICS.values()})
    limits = [
        {"messages": ["put"], "key_exprs": _keys(t for t in TOPICS.values() if t.max_bytes == size), "size_limit": size}
        for size in sizes
    ]
    action = action_topic_keys(SERVICES.values())
    limits.append({"messages": ["put"], "key_exprs": action, "size_limit": MAX_TOPIC_BYTES})
    requests = {"messages": ["query"], "key_exprs": ["**"], "size_limit": MAX_REQUEST_BYTES}
    return [{"flows": ["ingress"], **limit} for limit in (*limits, requests)]


def rate_limits(limit_hz: float = PEER_LIMIT_HZ) -> list[dict[str, Any]]:
    """zenoh's `downsampling`: the rate of each peer on the key of e-stops; the router drops what exceeds it.

    A driver looks at each e-stop as it arrives, so a flood would take its CPU. Whoever stops repeats it. No other topic
    has a limit: of two messages that reach the router while it is busy, however far apart they were sent, the newer one
    would be dropped. That may be a request to disarm after one to arm, or one for another robot.
    """
    topics = [topic for topic in TOPICS.values() if topic.type is EStop]
    rules = [{"key_expr": key, "freq": limit_hz} for key in _keys(topics)]
    return [{"id": "floods", "messages": ["put", "delete"], "flows": ["ingress"], "rules": rules}]


def _common_rules() -> list[dict[str, Any]]:
    everything = ["**"]
    inward, both = ["ingress"], ["ingress", "egress"]
    heard = ["put", "delete", "reply", "query", "declare_queryable"]
    look = ["liveliness_query", "declare_liveliness_subscriber"]
    return [
        _rule("subscribe", ["declare_subscriber"], both, everything),
        _rule("hear", heard, ["egress"], everything),
        _rule("look", look, both, ALL_TOKENS),
        _rule("be seen", ["liveliness_token"], ["egress"], ALL_TOKENS),
        _rule(GATEWAY, [*heard, "declare_subscriber", "liveliness_token", *look], inward, [*everything, *ALL_TOKENS]),
    ]


def _rules_of(role: Role) -> list[dict[str, Any]]:
    topics = [topic for topic in TOPICS.values() if role in may_publish(topic)]
    called = [service for service in SERVICES.values() if role in service.callers]
    served = [service for service in SERVICES.values() if role == service.server]
    rows = [
        ("publish", ["put"], [*_keys(topics), *action_topic_keys(served)]),
        ("call", ["query"], service_keys(called)),
    ]
    rows += [("serve", ["declare_queryable", "reply"], service_keys(served))]
    rows += [("announce", ["liveliness_token"], tokens(topics, called, served))]
    return [_rule(f"{role} {name}", kinds, ["ingress"], keys) for name, kinds, keys in rows if keys]


def _rule_names(subject: str, rules: Sequence[Mapping[str, Any]]) -> list[str]:
    own = [rule["id"] for rule in rules if rule["id"] == subject or rule["id"].startswith(f"{subject} ")]
    return ["subscribe", "hear", "look", "be seen", *own]


def _rule(name: str, messages: Sequence[str], flows: Sequence[str], keys: Sequence[str]) -> dict[str, Any]:
    return {"id": name, "messages": messages, "flows": flows, "permission": "allow", "key_exprs": keys}


def _keys(topics: Iterable[Topic]) -> list[str]:
    """Keys of topics under both key profiles."""
    topics = list(topics)
    return [*_plain_keys(topics), *ros_patterns(topics)]


def _plain_keys(topics: Iterable[Topic]) -> list[str]:
    return sorted({topic.key.format(robot="*") for topic in topics})
