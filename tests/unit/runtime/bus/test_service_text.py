"""Requests and responses are text; what is none, on either side, ends neither a loop nor a command."""

from types import SimpleNamespace

import pytest
import zenoh

from tailor.runtime.bus.service import text_request
from tailor.runtime.bus.session import Session
from tailor.schemas.errors import UsageError

HALF = "\ud800"  # of a character, as JSON can name it; a word of a command line that is no UTF-8 has others


def session(reply=None):
    """A session whose calls get this reply, and what it sent."""
    sent = []

    def get(key, payload, timeout, consolidation):
        sent.append(bytes(zenoh.ZBytes(payload)))
        return [reply] if reply else []

    opened = SimpleNamespace(
        info=SimpleNamespace(zid=lambda: "1"), liveliness=lambda: SimpleNamespace(declare_token=None), get=get
    )
    return Session(opened), sent


@pytest.mark.parametrize("accepted", [True, False])
def test_a_response_that_quotes_half_a_character_can_be_sent(accepted):
    """It ended the simulator that refused `place` with such a name."""
    sent = []
    query = SimpleNamespace(
        payload=None,
        key_expr="agilo/sim/place",
        reply=lambda key, payload: sent.append(bytes(zenoh.ZBytes(payload))),
        reply_err=lambda payload: sent.append(bytes(zenoh.ZBytes(payload))),
        drop=lambda: None,
    )
    request = text_request(query)
    (request.accept if accepted else request.refuse)(f"place: unknown name {HALF}, expected x\u00b0")
    assert sent == ["place: unknown name \\ud800, expected x\u00b0".encode()]


def test_a_request_that_is_no_text_is_sent_as_its_escapes():
    caller, sent = session()
    assert caller.call("exec/goal", "(atball \udcff)") == (False, "no service at exec/goal")
    assert sent == [b"(atball \\udcff)"]


def test_a_request_that_no_router_passes_on_is_refused_before_it_is_sent():
    """It was told that there is no such service."""
    caller, sent = session()
    refusal = "the request has 70000 bytes, expected at most 65536"
    assert caller.call_all("exec/goal", "a" * 70_000) == [(False, refusal)]
    assert sent == []


@pytest.mark.parametrize("accepted", [True, False])
def test_a_response_of_a_stranger_that_is_no_text_is_replaced(accepted):
    part = SimpleNamespace(payload=zenoh.ZBytes(b"\xff\xfe ok"))
    reply = SimpleNamespace(ok=part if accepted else None, err=None if accepted else part)
    assert session(reply)[0].call("exec/goal", "") == (accepted, "\ufffd\ufffd ok")


@pytest.mark.parametrize("key", ["agilo/\udcff", "a//b", "a/*", "", "a" * 1001])
def test_a_key_that_the_bus_cannot_carry_is_refused(key):
    with pytest.raises(UsageError, match="expected one that the bus can carry"):
        session()[0].player(key, "")
