"""A robot's traffic at a chosen rate, without a robot: what recorder and replay benchmarks are fed with."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from tailor.runtime.bus.session import Session
from tailor.runtime.clock import MonotonicClock
from tailor.runtime.loop import Loop
from tailor.schemas.messages import Odometry

MIX = ("odom", "odom", "odom", "odom")  # of one robot each; odometry is the longest of the frequent messages


@contextmanager
def traffic(session: Session, rate_hz: float) -> Iterator[None]:
    """Publish odometry of four robots, `rate_hz` messages a second in all, as long as the context lasts."""
    outlets = [session.publisher(name, f"robot{number}") for number, name in enumerate(MIX)]
    ended = threading.Event()

    def publish() -> None:
        loop = Loop(round(len(MIX) * 1e9 / rate_hz), MonotonicClock())
        while not ended.is_set():
            turn = loop.wait_for_next_period()
            x = (turn.now_ns % 10**9) / 1e9
            for outlet in outlets:
                outlet.publish(Odometry(time.time_ns(), x, -x, x, x, 0.1))

    thread = threading.Thread(target=publish)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
