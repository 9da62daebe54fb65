"""Questions that people ask a running process, answered from its loop: a PDDL goal, a simulator's reset."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol


class ServiceRequest:
    """One question with its text; answer it exactly once."""

    def __init__(self, text: str, answer: Callable[[bool, str], None]) -> None:
        self.text = text
        self._answer = answer

    def accept(self, said: str = "accepted") -> None:
        """Answer yes."""
        self._answer(True, said)

    def refuse(self, why: str) -> None:
        """Answer no, and why."""
        self._answer(False, why)


class RequestSource(Protocol):
    """Where questions come from; session.py makes it of a zenoh queryable."""

    def receive(self) -> ServiceRequest | None:
        """The oldest question that waits, None if there is none; never blocks."""
        ...


class ServiceServer:
    """The questions under one key, polled once a tick."""

    def __init__(self, source: RequestSource) -> None:
        self._source = source

    def poll(self) -> ServiceRequest | None:
        """The next question, None if nobody asks."""
        return self._source.receive()
