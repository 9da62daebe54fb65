"""Tells who starts a second process of a kind that a bus is to have one of: a driver of a robot, or an executive.

A base between two drivers obeys neither. Two executives take each goal, and people can arm a driver for one of them.
"""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterator

from tailor.runtime.aside import FINISH_S
from tailor.runtime.bus.encoding import encoding_of
from tailor.runtime.bus.inbox import origin_of
from tailor.runtime.bus.session import Session
from tailor.runtime.realtime import take_ordinary
from tailor.schemas.errors import Rejected
from tailor.schemas.topics import TOPICS, key_of

LISTEN_S = 0.35  # drivers publish their state ten times a second, as executives do


@contextlib.contextmanager
def other_drivers_noted(session: Session, robot: str, report: Callable[[str], None]) -> Iterator[None]:
    """Listen for LISTEN_S, beside a driver that must not wait; report once if another one is heard.

    Args:
      session: That of the driver, whose own state does not count.
      robot: Name of its robot.
      report: Receives the line, in another thread.
    """
    text = f"another driver of {robot} is on the bus: {{}}; expected one: `tailor arm` arms none of several"
    with _others_noted(session, "driver", robot, lambda which: report(text.format(which))):
        yield


@contextlib.contextmanager
def other_executives_noted(session: Session, report: Callable[[str], None]) -> Iterator[None]:
    """As `other_drivers_noted`, of executives, whatever their robots: services and topics of all have the same keys."""
    why = "each takes every goal, and `tailor arm` arms for none of several"
    text = f"another executive is on the bus: {{}}; expected one: {why}"
    with _others_noted(session, "status", "", lambda which: report(text.format(which))):
        yield


@contextlib.contextmanager
def _others_noted(session: Session, topic: str, robot: str, report: Callable[[str], None]) -> Iterator[None]:
    """Report the senders of a topic, short, if there are any but this session."""
    key, encoding = key_of(topic, robot), encoding_of(TOPICS[topic].type)
    heard, subscriptions = session.subscribe_all(key)
    ended = threading.Event()

    def listen() -> None:
        take_ordinary()
        over = ended.wait(LISTEN_S)
        subscriptions.undeclare()
        origins = [origin_of(raw, key, encoding) for raw in heard.drain()]
        senders = sorted({each.sender for each in origins if not isinstance(each, Rejected)} - {session.sender, ""})
        if senders and not over:
            report(", ".join(sender[:8] for sender in senders))

    thread = threading.Thread(target=listen, name="others", daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join(FINISH_S)
