"""A zenoh session with its publishers, inboxes, services and subscriptions; only it and `wires.py` import zenoh."""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any

import zenoh

from tailor.runtime.bus.attachment import SENDER_BYTES
from tailor.runtime.bus.encoding import encoding_named, encoding_of
from tailor.runtime.bus.inbox import EVENT_DEPTH, Inbox, Source
from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.runtime.bus.latch import EStopLatch
from tailor.runtime.bus.publisher import Publisher
from tailor.runtime.bus.ros_wires import Announcer, GraphView, RosCall, as_plain, goal_request, ros_call
from tailor.runtime.bus.service import (
    MAX_NEW,
    QueryableSource,
    RequestSource,
    ServiceRequest,
    ServiceServer,
    no_service,
    text_of,
    text_request,
    too_long_request,
)
from tailor.runtime.bus.wires import MAX_PLAIN_BYTES, RingSource, Subscriptions, Wire, raw_of, received_raw
from tailor.runtime.clock import wall_ns
from tailor.schemas.errors import UsageError
from tailor.schemas.ros2.graph import ADMIN_SPACE, Kind, Named, parsed_key
from tailor.schemas.ros2.profiles import BARE, COPY, PLAIN, KeyProfile, ros_topic, topic_at
from tailor.schemas.services import MAX_REQUEST_BYTES, SERVICES
from tailor.schemas.topics import TOPICS, Priority, Topic, key_of

MAX_KEY_BYTES = 1000  # of a key; a zenoh message carries up to 65 535
MAX_ENCODING_BYTES = 255  # zenoh panics at a longer one, in the midst of a put
_PRIORITIES = {
    "real_time": zenoh.Priority.REAL_TIME,
    "interactive_high": zenoh.Priority.INTERACTIVE_HIGH,
    "data": zenoh.Priority.DATA,
}


class CannotOpenError(Exception):
    """No session opens with a configuration; the message is zenoh's."""


@contextmanager
def opened(config: str, sender: str = "", keys: KeyProfile = PLAIN, node: str = "observer") -> Iterator[Session]:
    """Session with a configuration of zenoh_config.py.

    Args:
      config: zenoh's configuration in JSON.
      sender: Id of the session on the bus, 32 hex digits; empty: random.
      keys: Key profile.
      node: What ROS 2 knows it as, behind "tailor_".

    Raises:
      CannotOpenError: See its message.
    """
    try:
        session = zenoh.open(zenoh.Config.from_json5(config))
    except zenoh.ZError as error:
        raise CannotOpenError(str(error)) from error
    with session:
        ours = Session(session, sender, keys, node)
        try:
            yield ours
        finally:
            ours.undeclare()


class Session:
    """One process on the bus; `sender` is its id: 32 hex digits."""

    def __init__(
        self, opened: zenoh.Session, sender: str = "", keys: KeyProfile = PLAIN, node: str = "observer"
    ) -> None:
        self.sender = sender or secrets.token_hex(SENDER_BYTES)
        self.keys = keys
        self._zenoh = opened
        self._kept: list[Any] = []  # subscriptions that live as long as the session
        self._publishers: list[zenoh.Publisher] = []  # one that outlives its session keeps 14 kB of it for good
        self._graph = Announcer(str(opened.info.zid()), f"tailor_{node}", opened.liveliness().declare_token)

    @property
    def connected(self) -> bool:
        """Whether the router is connected; zenoh reconnects by itself."""
        return bool(self._zenoh.info.routers_zid())

    def undeclare(self) -> None:
        """End all publishers: before the session closes."""
        for each in self._publishers:
            with suppress(zenoh.ZError):
                each.undeclare()  # type: ignore[no-untyped-call]
        self._publishers.clear()

    def publisher(self, name: str, robot: str) -> Publisher:
        """Publisher of a topic of tailor.schemas.topics; drops messages rather than wait."""
        topic, key = TOPICS[name], key_of(name, robot)
        wires = [self._wire(each, encoding, topic.priority) for each, encoding in self._keys_of(topic, key)]
        if self.keys.announces:
            self._graph.announce(Kind.PUBLISHER, ros_topic(topic, robot), self.keys.domain)
        return Publisher(key, Wire(wires), self.sender)

    def _keys_of(self, topic: Topic, key: str) -> list[tuple[str, str]]:
        """Keys of a topic in this session's profile, each with the encoding of what is published there."""
        keys = [(key, encoding_of(topic.type))] if self.keys.plain(topic) else []
        if self.keys.ros(topic):
            named = ros_topic(topic, key.partition("/")[0])
            keys.append((named.key(self.keys.domain), COPY if keys else BARE))
        return keys

    def _wire(self, key: str, encoding: str, priority: Priority) -> zenoh.Publisher:
        declared = self._zenoh.declare_publisher(
            key,
            encoding=encoding,
            priority=_PRIORITIES[priority],
            congestion_control=zenoh.CongestionControl.DROP,  # a stalled reader must never stall a tick
            express=priority != "data",
        )
        self._publishers.append(declared)
        return declared

    def player(self, key: str, ros_type: str) -> Publisher:
        """Publisher of recorded bytes under any key; waits rather than drop, so never use it in a tick.

        A topic of the table is published under the keys of this session's profile. The router drops what a subscriber
        does not read in time. Its queues hold batches, so messages share them: apart, a fast replay would lose most.

        Raises:
          UsageError: The key is invalid, or a pattern, or the name of the type too long.
        """
        if not _is_one_key(key):
            raise UsageError(f"key '{key[:100]}': expected one that the bus can carry, such as agilo/odom")
        topic, encoding = topic_at(key), encoding_named(ros_type) if ros_type else None
        if encoding is not None and len(encoding.encode(errors="replace")) > MAX_ENCODING_BYTES:
            raise UsageError(f"key '{key}': type '{ros_type[:100]}…', expected a name that the bus can carry")
        known = topic is not None and encoding == encoding_of(topic.type)
        keys = self._keys_of(topic, key) if topic is not None and known else [(key, encoding)]
        declared = [
            self._zenoh.declare_publisher(each, encoding=encoded, congestion_control=zenoh.CongestionControl.BLOCK)
            for each, encoded in keys
        ]
        self._publishers += declared
        return Publisher(key, Wire(declared), self.sender)

    def plain_publisher(self, key: str, encoding: str) -> Publisher:
        """Publisher of commands on a topic of a robot that knows nothing of us; drops rather than wait."""
        self._announce_key(Kind.PUBLISHER, key)
        return Publisher(key, Wire([self._wire(key, encoding, "real_time")]), self.sender)

    def plain_source(self, key: str) -> Source:
        """Raw messages of one topic of such a robot; the newest few between two looks."""
        self._announce_key(Kind.SUBSCRIPTION, key)
        return self._ring(key, MAX_PLAIN_BYTES)

    def raw_sources(self, name: str, robot: str) -> list[Source]:
        """Raw messages of a topic of ours, one source for each of its keys in this session's profile."""
        topic = TOPICS[name]
        return [self._ring(each, topic.max_bytes) for each, _ in self._keys_of(topic, key_of(name, robot))]

    def graph_view(self, domain: int) -> GraphView:
        """What ROS 2 nodes of a domain announce, from now on and as long as the session lives."""
        view = GraphView()

        def note(sample: zenoh.Sample) -> None:
            view.note(str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT)

        handler: Any = zenoh.handlers.Callback(note, indirect=False)
        tokens = self._zenoh.liveliness().declare_subscriber(f"{ADMIN_SPACE}/{domain}/**", handler, history=True)
        self._kept.append(tokens)
        return view

    def _announce_key(self, kind: Kind, key: str) -> None:
        """Show ROS 2 what this session has at a key, if it is one of rmw_zenoh's."""
        parsed = parsed_key(key)
        if parsed is not None:
            self._graph.announce(kind, parsed[1], parsed[0])

    def inbox(self, names: Sequence[str], robot: str, newest_only: bool = True) -> Inbox:
        """Subscribe to topics; a loop drains the inbox.

        Args:
          names: Names of topics.
          robot: Name of the robot.
          newest_only: Keep only the newest sample of a state topic; else several, to distinguish senders.
        """
        subscriptions = []
        for name in names:
            topic, key = TOPICS[name], key_of(name, robot)
            for each, _ in self._keys_of(topic, key):
                source = self._latch(topic, key, each) if name == "estop" else self._ring(each, topic.max_bytes)
                subscriptions.append((topic, key, source))
            if self.keys.announces:
                self._graph.announce(Kind.SUBSCRIPTION, ros_topic(topic, robot), self.keys.domain)
        return Inbox(subscriptions, time.monotonic_ns, newest_only=newest_only)

    def _ring(self, key: str, max_bytes: int) -> Source:
        ring = self._zenoh.declare_subscriber(key, zenoh.handlers.RingChannel(EVENT_DEPTH))
        return RingSource(ring, self.keys, max_bytes)

    def _latch(self, topic: Topic, key: str, at: str) -> Source:
        latch = EStopLatch(topic, key)

        def offer(sample: zenoh.Sample) -> None:
            raw = as_plain(raw_of(sample, topic.max_bytes), self.keys)
            if raw is not None:
                latch.offer(raw)

        self._kept.append(self._zenoh.declare_subscriber(at, zenoh.handlers.Callback(offer, indirect=False)))
        return latch

    def service_server(self, key: str, *others: RequestSource) -> ServiceServer:
        """Server of the requests under `key`, of ROS 2's if it knows the service, and of others; a loop polls it."""
        sources: list[RequestSource] = [
            QueryableSource(self._zenoh.declare_queryable(key, zenoh.handlers.RingChannel(MAX_NEW)), text_request)
        ]
        if self.keys.announces and key == SERVICES["goal"].pattern:
            from tailor.schemas.ros2 import service

            service.prime()
            sources.append(self.ros_service(service.set_goal(), goal_request))
        return ServiceServer(*sources, *others)

    def ros_service(self, named: Named, read: Callable[[RosCall], ServiceRequest | None]) -> RequestSource:
        """Requests of ROS 2's clients of a service, under rmw_zenoh; `read` is as of QueryableSource."""
        calls: Any = zenoh.handlers.RingChannel(MAX_NEW)
        # A client of ROS 2 calls only queryables that are declared complete.
        queryable = self._zenoh.declare_queryable(named.key(self.keys.domain), calls, complete=True)
        self._graph.announce(Kind.SERVICE, named, self.keys.domain)
        return QueryableSource(queryable, lambda query: read(ros_call(query)))

    def ros_publisher(self, named: Named) -> Publisher:
        """Publisher of a topic that ROS 2 knows under rmw_zenoh, and the table of topics does not."""
        key = named.key(self.keys.domain)
        self._graph.announce(Kind.PUBLISHER, named, self.keys.domain)
        return Publisher(key, Wire([self._wire(key, BARE, "data")]), self.sender)

    def call(self, key: str, text: str, timeout_s: float = 2.0) -> tuple[bool, str]:
        """Send a request to the service `key` and wait for the response.

        Returns:
          (accepted, response); (False, reason) if there is no such service or no response in time.
        """
        return next(self._responses(key, text, timeout_s), (False, no_service(key)))

    def call_all(self, key: str, text: str, timeout_s: float = 2.0) -> list[tuple[bool, str]]:
        """Send a request to every process that serves `key`; their responses as of `call`, at least one."""
        return list(self._responses(key, text, timeout_s)) or [(False, no_service(key))]

    def _responses(self, key: str, text: str, timeout_s: float) -> Iterator[tuple[bool, str]]:
        sent = text.encode(errors="backslashreplace")  # a word of a command line need not be text
        if len(sent) > MAX_REQUEST_BYTES:  # a router passes none of these on, and nobody would answer
            yield False, too_long_request(len(sent))
            return
        every = zenoh.ConsolidationMode.NONE  # else of several responses under one key only the newest arrives
        for reply in self._zenoh.get(key, payload=sent, timeout=timeout_s, consolidation=every):
            if reply.ok is not None:
                yield True, text_of(reply.ok.payload)
            else:
                error = "" if reply.err is None else text_of(reply.err.payload)
                yield False, f"no response within {timeout_s:g} s" if error == "Timeout" else error

    def subscribe_all(self, pattern: str, queue: IngestQueue | None = None) -> tuple[IngestQueue, Subscriptions]:
        """Subscribe to all keys that match a pattern of plain keys; undeclare the returned subscriptions at the end.

        What comes under a key for rmw_zenoh gets its plain key, if this session's profile hears it.

        Args:
          pattern: Of keys.
          queue: Takes what is received; None: a new one.
        """
        filled = IngestQueue() if queue is None else queue

        def put(sample: zenoh.Sample) -> None:  # copied in zenoh's thread: a waiting sample pins its whole batch
            raw = as_plain(received_raw(sample, wall_ns()), self.keys)
            if raw is not None:
                filled.put(raw)

        patterns = [pattern]
        if self.keys.announces and pattern != "**":
            patterns.append(f"{self.keys.domain}/{pattern}/*/*")  # any type and hash; `as_plain` compares them
        handler: Any = zenoh.handlers.Callback(put, indirect=False)
        return filled, Subscriptions([self._zenoh.declare_subscriber(each, handler) for each in patterns])


def _is_one_key(key: str) -> bool:
    """Whether zenoh accepts a key and it is not a pattern."""
    try:
        zenoh.KeyExpr(key)
    except (zenoh.ZError, UnicodeEncodeError):
        return False
    return "*" not in key and len(key.encode()) <= MAX_KEY_BYTES
