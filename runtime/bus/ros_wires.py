"""A session's side of rmw_zenoh, without zenoh: its and others' tokens, received keys as plain ones, requests."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from threading import Lock
from typing import Any

from tailor.runtime.bus.attachment import Origin, pack, unpack
from tailor.runtime.bus.encoding import encoding_of, named_type
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.bus.service import ServiceRequest
from tailor.runtime.clock import wall_ns
from tailor.schemas.errors import Rejected
from tailor.schemas.ros2.graph import Announced, Kind, Named, Node, parsed_token, qos
from tailor.schemas.ros2.profiles import BARE, COPY, KeyProfile


class Announcer:
    """Tokens of one node: they end with its session, so what a process declares disappears with it."""

    def __init__(self, session: str, name: str, declare: Callable[[str], Any]) -> None:
        """Announce nothing yet.

        Args:
          session: zenoh's id of the session.
          name: Name of the node.
          declare: Declares a liveliness token; what it returns is kept.
        """
        self._session, self._name, self._declare = session, name, declare
        self._tokens: dict[tuple[int, Kind, Named | None], Any] = {}  # one each, however often a topic is subscribed to

    def announce(self, kind: Kind, what: Named, domain: int) -> None:
        """Declare a publisher, subscription, service or client; before the first one of a domain the node itself."""
        node = Node(domain, self._session, self._name)
        if (domain, Kind.NODE, None) not in self._tokens:
            self._tokens[domain, Kind.NODE, None] = self._declare(node.token())
        if (domain, kind, what) not in self._tokens:
            # Best effort: the one quality of service of a subscription that matches every publisher.
            quality = qos(reliable=kind is not Kind.SUBSCRIPTION)
            self._tokens[domain, kind, what] = self._declare(node.token_of(len(self._tokens), kind, what, quality))


class GraphView:
    """What nodes announce at the moment, by the tokens that live; zenoh's thread notes them, any thread reads them."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._tokens: dict[str, Announced] = {}

    def note(self, token: str, lives: bool) -> None:
        """A token appeared or disappeared; other texts than tokens are left out."""
        announced = parsed_token(token)
        with self._lock:
            if lives and announced is not None:
                self._tokens[token] = announced
            else:
                self._tokens.pop(token, None)

    def announced(self) -> tuple[Announced, ...]:
        """What is announced now."""
        with self._lock:
            return tuple(self._tokens.values())


def as_plain(raw: Raw, keys: KeyProfile) -> Raw | None:
    """A received publication under its plain key.

    One that comes under a key for rmw_zenoh which this session does not hear stays as it is.

    Returns:
      The publication; None if it is the copy of one that the session hears under its plain key.
    """
    known = keys.heard(raw.key)
    if known is None:
        return raw
    key, topic = known
    if raw.encoding == COPY and keys.plain(topic):
        return None
    names_type = named_type(raw.encoding) and raw.encoding != COPY
    return replace(raw, key=key, encoding=raw.encoding if names_type else encoding_of(topic.type))


class RosCall:
    """A client's call of a service of ROS 2, `data` its CDR bytes; respond exactly once."""

    def __init__(self, data: bytes, attachment: bytes | None, send: Callable[[bytes, bytes | None], None]) -> None:
        """A call that arrived.

        Args:
          data: The request.
          attachment: Its number and its client, which the response repeats.
          send: Sends the CDR bytes and the attachment of the response.
        """
        self.data = data
        self._attachment, self._send = attachment, send

    def respond(self, response: bytes) -> None:
        """Send the CDR bytes of the response."""
        origin = unpack(self._attachment)
        if isinstance(origin, Origin) and origin.sender:
            self._send(response, pack(replace(origin, source_ns=wall_ns())))
        else:
            self._send(response, None)


def ros_call(query: Any) -> RosCall:
    """The call in one of zenoh's queries."""
    payload, attachment = (None if part is None else part.to_bytes() for part in (query.payload, query.attachment))

    def send(response: bytes, origin: bytes | None) -> None:
        query.reply(query.key_expr, response, encoding=BARE, attachment=origin)
        query.drop()

    return RosCall(payload or b"", attachment, send)


def goal_request(call: RosCall) -> ServiceRequest | None:
    """The request in a call of `tailor_msgs/srv/SetGoal`; None if it was damaged, and is refused already."""
    from tailor.schemas.ros2.service import goal_of, response

    def respond(accepted: bool, text: str) -> None:
        call.respond(response(accepted, text))

    goal = goal_of(call.data)
    if isinstance(goal, Rejected):
        respond(False, f"the request is {goal.reason}")
        return None
    return ServiceRequest(goal, respond)
