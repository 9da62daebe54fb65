"""Services of a running process, served from its loop: e.g. a PDDL goal, or the reset of a simulator."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from typing import Any, Protocol

from tailor.schemas.services import MAX_REQUEST_BYTES

MAX_WAITING = 16  # requests of one source, of which a loop serves one in a period
MAX_NEW = 64  # between two periods: those that cannot wait are refused; of more, zenoh forgets the oldest
BUSY = f"{MAX_WAITING} other requests are waiting; send this one again"
ACCEPTED = "accepted"  # response to a request that is carried out from now on; another one says what was done at once


class ServiceRequest:
    """Request of a client; call `accept` or `refuse` exactly once.

    Attributes:
      text: What is requested.
      taken_ns: Monotonic time at which this process took it from the bus; None: now. It may have waited since.
    """

    def __init__(self, text: str, respond: Callable[[bool, str], None]) -> None:
        self.text = text
        self.taken_ns: int | None = None
        self._respond = respond

    def accept(self, response: str = ACCEPTED) -> None:
        """Respond that the request is accepted."""
        self._respond(True, response)

    def refuse(self, reason: str) -> None:
        """Respond that the request is refused."""
        self._respond(False, reason)


class RequestSource(Protocol):
    """Source of requests."""

    def receive(self) -> ServiceRequest | None:
        """Oldest waiting request, None if there is none; never blocks."""
        ...


class QueryableSource:
    """Requests that wait in one of zenoh's queryables; `read` makes a request of a query, None if it refused it.

    A query for a pattern reaches every queryable that matches: `get("**")`, with which people look at a bus, is no
    request for an empty goal. It gets no reply.
    """

    def __init__(
        self,
        queryable: Any,
        read: Callable[[Any], ServiceRequest | None],
        now_ns: Callable[[], int] = time.monotonic_ns,
    ) -> None:
        self._queryable, self._read, self._now_ns = queryable, read, now_ns
        self._waiting: deque[tuple[Any, int]] = deque()  # with the time at which each was taken from zenoh

    def receive(self) -> ServiceRequest | None:
        """See RequestSource."""
        self._take()
        if not self._waiting:
            return None
        query, taken_ns = self._waiting.popleft()
        request = self._read(query)
        if request is not None:
            request.taken_ns = taken_ns
        return request

    def _take(self) -> None:
        """Take all that zenoh has: one that it forgets is told that there is no such service, if anything."""
        for _ in range(MAX_NEW):
            query = self._queryable.try_recv()
            if query is None:
                return
            if not self._is_request(query):
                continue
            if len(self._waiting) < MAX_WAITING:
                self._waiting.append((query, self._now_ns()))
            elif (request := self._read(query)) is not None:
                request.refuse(BUSY)

    def _is_request(self, query: Any) -> bool:
        """False for a query that is none, or one that is refused unread."""
        if str(query.key_expr) != str(self._queryable.key_expr):
            query.drop()
            return False
        length = max(len(part) for part in (query.payload or b"", query.attachment or b""))
        if length > MAX_REQUEST_BYTES:  # unread: to decode 400 MB takes a second of the loop that serves it
            query.reply_err(too_long_request(length))
            query.drop()
            return False
        return True


def no_service(key: str) -> str:
    """What a call returns where nobody declares the service."""
    return f"no service at {key}"


def too_long_request(length: int) -> str:
    """What a request of so many bytes is refused with."""
    return f"the request has {length} bytes, expected at most {MAX_REQUEST_BYTES}"


def text_of(payload: Any) -> str:
    """A request or response, of whatever process: bytes that are no UTF-8 are replaced."""
    return str(payload.to_bytes().decode(errors="replace"))


def text_request(query: Any) -> ServiceRequest:
    """The request in a query whose payload is text; the response is text as well."""
    payload = query.payload
    text = "" if payload is None else text_of(payload)

    def respond(accepted: bool, response: str) -> None:
        sent = response.encode(errors="backslashreplace")  # half a character, as JSON may name one, is no text
        if accepted:
            query.reply(query.key_expr, sent)
        else:
            query.reply_err(sent)
        query.drop()

    return ServiceRequest(text, respond)


class ServiceServer:
    """Requests of one service, polled once a tick; its sources take turns, so that many from one delay no other."""

    def __init__(self, *sources: RequestSource) -> None:
        self._sources = list(sources)  # the one whose request was served last is the last

    def poll(self) -> ServiceRequest | None:
        """Next request, None if there is none."""
        for source in tuple(self._sources):
            if (request := source.receive()) is not None:
                self._sources.remove(source)
                self._sources.append(source)
                return request
        return None
