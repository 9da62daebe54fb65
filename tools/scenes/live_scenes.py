"""Publishes the scenes of a running system: a subscriber of its own, which delays no other process."""

from __future__ import annotations

from collections.abc import Callable

from tailor.runtime.bus.attachment import unpack
from tailor.runtime.bus.inbox import message_of
from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.runtime.bus.publisher import Publisher
from tailor.runtime.bus.session import Session
from tailor.runtime.clock import MonotonicClock
from tailor.runtime.loop import Loop
from tailor.runtime.processes.notify import SILENT, Notifier
from tailor.schemas.errors import Rejected
from tailor.tools.scenes.scene_feed import SceneFeed

POLL_NS = 50_000_000


def publish_scenes(session: Session, stopped: Callable[[], bool], notifier: Notifier = SILENT) -> None:
    """Publish until `stopped` is True.

    Args:
      session: With a role that may publish scenes.
      stopped: Called twenty times a second.
      notifier: Receives that it subscribes, a report of every look, and a package's fault.
    """
    queue, subscription = session.subscribe_all("**")
    try:
        _publish(session, queue, stopped, notifier)
    finally:
        subscription.undeclare()


def _publish(session: Session, queue: IngestQueue, stopped: Callable[[], bool], notifier: Notifier) -> None:
    loop, feed, publishers, fault = Loop(POLL_NS, MonotonicClock()), SceneFeed(), dict[str, Publisher](), ""
    notifier.ready()
    while not stopped():
        period = loop.wait_for_next_period()
        for raw in queue.drain():
            wanted = feed.wants(raw.key) and not isinstance(unpack(raw.attachment), Rejected)
            message = message_of(raw) if wanted else None
            if message is None:
                continue
            for topic, made in feed.messages_after(period.now_ns / 1e9, raw.key, message):
                if topic not in publishers:
                    publishers[topic] = session.publisher(topic, feed.robot)
                publishers[topic].publish(made)
        notifier.alive()
        if feed.fault != fault:
            fault = feed.fault
            notifier.status(f"scene: {fault}")
