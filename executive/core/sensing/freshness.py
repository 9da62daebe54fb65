"""Age of every input by the receiver's clock; a sender's stamp never makes data fresher."""

from __future__ import annotations

from collections.abc import Mapping

from tailor.schemas.messages import DriverState, Sample
from tailor.schemas.topics import TOPICS, key_of

MAX_ROUND_TRIP_NS = 750_000_000  # 300 ms each way, a period of the driver state, and 50 ms; below 800 ms one way


def newest_arrivals(arrivals: Mapping[str, int], samples: tuple[Sample, ...]) -> dict[str, int]:
    """Newest arrival in ns by key, `samples` included."""
    newest = dict(arrivals)
    for sample in samples:
        newest[sample.key] = max(newest.get(sample.key, sample.arrival_ns), sample.arrival_ns)
    return newest


def is_stale(topic: str, arrival_ns: int | None, now_ns: int, unlimited_s: float | None = None) -> bool:
    """Whether the newest sample of a topic is older than its limit in the table, or has never arrived.

    Args:
      topic: Name of the topic.
      arrival_ns: Arrival of its newest sample; None: there was none.
      now_ns: Time to judge at.
      unlimited_s: Limit of a topic that has none in the table; None: it is never stale.
    """
    limit_s = TOPICS[topic].fresh_s
    if limit_s is None:
        limit_s = unlimited_s
    if limit_s is None:
        return False
    return arrival_ns is None or now_ns - arrival_ns > limit_s * 1e9


def stale_topics(topics: tuple[str, ...], robot: str, arrivals: Mapping[str, int], now_ns: int) -> tuple[str, ...]:
    """Those of `topics` that are stale."""
    return tuple(topic for topic in topics if is_stale(topic, arrivals.get(key_of(topic, robot)), now_ns))


def echo_age_ns(state: DriverState, arrival_ns: int, stamp_offset_ns: int) -> int:
    """Age in ns of the newest command that a driver's state echoes, as the state arrives; 0 without one.

    Both times come from this executive's clock. The age includes both ways and up to a period of the driver state.
    """
    return arrival_ns + stamp_offset_ns - state.command_stamp_ns if state.command_stamp_ns else 0
