"""Services of a running process, served from its loop: e.g. a PDDL goal, or the reset of a simulator."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol


class ServiceRequest:
    """Request of a client; call `accept` or `refuse` exactly once."""

    def __init__(self, text: str, respond: Callable[[bool, str], None]) -> None:
        self.text = text
        self._respond = respond

    def accept(self, response: str = "accepted") -> None:
        """Respond that the request is accepted."""
        self._respond(True, response)

    def refuse(self, reason: str) -> None:
        """Respond that the request is refused."""
        self._respond(False, reason)


class RequestSource(Protocol):
    """Source of requests; session.py implements it with a zenoh queryable."""

    def receive(self) -> ServiceRequest | None:
        """Oldest waiting request, None if there is none; never blocks."""
        ...


class ServiceServer:
    """Requests of one service, polled once a tick."""

    def __init__(self, *sources: RequestSource) -> None:
        self._sources = sources

    def poll(self) -> ServiceRequest | None:
        """Next request, None if there is none."""
        for source in self._sources:
            if (request := source.receive()) is not None:
                return request
        return None
