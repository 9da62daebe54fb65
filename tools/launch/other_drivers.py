"""Tells who starts a driver that another one of its robot is on the bus: a base between the two obeys neither."""

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

LISTEN_S = 0.35  # drivers publish their state ten times a second


@contextlib.contextmanager
def other_drivers_noted(session: Session, robot: str, report: Callable[[str], None]) -> Iterator[None]:
    """Listen for LISTEN_S, beside a driver that must not wait; report once if another one is heard.

    Args:
      session: That of the driver, whose own state does not count.
      robot: Name of its robot.
      report: Receives the line, in another thread.
    """
    key, encoding = key_of("driver", robot), encoding_of(TOPICS["driver"].type)
    heard, subscriptions = session.subscribe_all(key)
    ended = threading.Event()

    def listen() -> None:
        take_ordinary()
        over = ended.wait(LISTEN_S)
        subscriptions.undeclare()
        origins = [origin_of(raw, key, encoding) for raw in heard.drain()]
        senders = sorted({each.sender for each in origins if not isinstance(each, Rejected)} - {session.sender, ""})
        if senders and not over:
            which = ", ".join(sender[:8] for sender in senders)
            report(f"another driver of {robot} is on the bus: {which}; expected one: `tailor arm` arms none of several")

    thread = threading.Thread(target=listen, name="other drivers", daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join(FINISH_S)
