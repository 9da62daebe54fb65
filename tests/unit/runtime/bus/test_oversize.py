"""Payloads beyond any limit are judged by their length: to copy them would take the loop that reads them a tick."""

from types import SimpleNamespace

import pytest
import zenoh

from tailor.runtime.bus.inbox import EVENT_DEPTH, Inbox
from tailor.runtime.bus.ingest_queue import OVERHEAD_BYTES
from tailor.runtime.bus.service import QueryableSource, text_request
from tailor.runtime.bus.wires import RingSource, received_raw
from tailor.schemas.codec import encode
from tailor.schemas.messages import Odometry
from tailor.schemas.ros2.profiles import COPY, PLAIN, KeyProfile, ros_topic
from tailor.schemas.services import MAX_REQUEST_BYTES
from tailor.schemas.topics import TOPICS

KEY = "agilo/odom"
ODOM = TOPICS["odom"]
GOOD = encode(Odometry(0, 1.0, 2.0, 0.5, 0.1, 0.2))


class Unread:
    """A payload of many bytes that nobody may copy."""

    def __init__(self, length):
        self._length = length

    def __len__(self):
        return self._length

    def to_bytes(self):
        raise AssertionError("copied")


class Payload(bytes):
    def to_bytes(self):
        return bytes(self)


def sample(payload, attachment=None):
    parts = {"key_expr": KEY, "payload": payload, "attachment": attachment, "encoding": "", "timestamp_stack": None}
    return SimpleNamespace(**parts, kind=zenoh.SampleKind.PUT)


def inbox_of(*payloads):
    waiting = [each if isinstance(each, SimpleNamespace) else sample(each) for each in payloads]
    ring = SimpleNamespace(try_recv=lambda: waiting.pop(0) if waiting else None)
    return Inbox([(ODOM, KEY, RingSource(ring, PLAIN, ODOM.max_bytes))], lambda: 0, lambda: 0)


@pytest.mark.promise("P17")
@pytest.mark.parametrize("length", [ODOM.max_bytes + 1, 400_000_000])
def test_an_oversize_message_is_refused_unread(length):
    inbox = inbox_of(Unread(length), Payload(GOOD))
    assert [each.message.x for each in inbox.drain()] == [1.0]
    assert dict(inbox.rejected) == {(KEY, "too long"): 1}


@pytest.mark.promise("P17")
@pytest.mark.parametrize("length", [256, 400_000_000])
def test_an_oversize_attachment_is_refused_unread(length):
    inbox = inbox_of(sample(Payload(GOOD), Unread(length)), Payload(GOOD))
    assert [each.message.x for each in inbox.drain()] == [1.0]
    assert dict(inbox.rejected) == {(KEY, "bad attachment"): 1}


@pytest.mark.promise("P17")
def test_a_message_that_waits_for_a_recorder_takes_no_more_memory_than_it_counts():
    """What a snapshot keeps is limited by the payloads: 13 attachments of 20 MB a second were 8 GB in 30 s."""
    raw = received_raw(sample(Payload(GOOD), Unread(20_000_000)), 1)
    assert len(raw.attachment) == 256
    assert len(raw.attachment) < OVERHEAD_BYTES


def test_a_message_of_the_largest_length_is_read():
    inbox = inbox_of(Payload(GOOD + bytes(ODOM.max_bytes - len(GOOD))))
    assert inbox.drain() == ()
    assert dict(inbox.rejected) == {(KEY, "trailing bytes"): 1}


@pytest.mark.promise("P17")
def test_of_a_flood_of_copies_a_turn_has_an_end():
    """A session that hears both keys takes a message once; what it leaves out is reading, too."""
    copy, read = SimpleNamespace(**{**vars(sample(Payload(GOOD))), "encoding": COPY}), []
    copy.key_expr = ros_topic(ODOM, "agilo").key(0)

    def flood():
        read.append(1)
        assert len(read) < 1000, "no end"
        return copy

    ring = RingSource(SimpleNamespace(try_recv=flood), KeyProfile("both"), ODOM.max_bytes)
    assert Inbox([(ODOM, KEY, ring)], lambda: 0, lambda: 0).drain() == ()
    assert len(read) == EVENT_DEPTH


class Query:
    """A query as zenoh has it, with what it was answered."""

    def __init__(self, payload, attachment=None):
        self.key_expr, self.payload, self.attachment = "exec/goal", payload, attachment
        self.errors, self.dropped = [], False

    def reply_err(self, text):
        self.errors.append(text)

    def drop(self):
        self.dropped = True


def served(query):
    queries = [query]
    queryable = SimpleNamespace(key_expr="exec/goal", try_recv=lambda: queries.pop() if queries else None)
    return QueryableSource(queryable, text_request).receive()


@pytest.mark.promise("P17")
@pytest.mark.parametrize("where", ["payload", "attachment"])
def test_an_oversize_request_is_refused_unread(where):
    query = Query(**{"payload": Payload(b"(good)"), where: Unread(MAX_REQUEST_BYTES + 1)})
    assert served(query) is None
    assert query.errors == ["the request has 65537 bytes, expected at most 65536"]
    assert query.dropped


@pytest.mark.parametrize("payload", [None, Payload(b"(good)"), Payload(b"x" * MAX_REQUEST_BYTES)])
def test_a_request_of_up_to_the_largest_length_is_served(payload):
    assert served(Query(payload)).text == ("" if payload is None else payload.decode())
