"""Synthetic bus traffic at a given rate, input of the benchmarks of recorder and replay."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from tailor.runtime.bus.session import Session
from tailor.runtime.clock import MonotonicClock
from tailor.runtime.loop import Loop
from tailor.schemas.messages import Odometry

TOPICS = ("odom", "odom", "odom", "odom")  # one for each robot; odometry is the longest of the frequent messages


@contextmanager
def traffic(session: Session, rate_hz: float) -> Iterator[None]:
    """Publish odometry of four robots, `rate_hz` messages a second in total, until the context ends."""
    publishers = [session.publisher(topic, f"robot{number}") for number, topic in enumerate(TOPICS)]
    ended = threading.Event()

    def publish() -> None:
        loop = Loop(round(len(TOPICS) * 1e9 / rate_hz), MonotonicClock())
        while not ended.is_set():
            period = loop.wait_for_next_period()
            x = (period.now_ns % 10**9) / 1e9
            for publisher in publishers:
                publisher.publish(Odometry(time.time_ns(), x, -x, x, x, 0.1))

    thread = threading.Thread(target=publish)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
