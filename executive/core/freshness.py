"""Age of every input by the receiver's clock; a sender's stamp never makes data fresher."""

from __future__ import annotations

from collections.abc import Mapping

from tailor.schemas.messages import Sample
from tailor.schemas.topics import TOPICS, key_of


def newest_arrivals(arrivals: Mapping[str, int], samples: tuple[Sample, ...]) -> dict[str, int]:
    """Newest arrival in ns by key, `samples` included."""
    newest = dict(arrivals)
    for sample in samples:
        newest[sample.key] = max(newest.get(sample.key, sample.arrival_ns), sample.arrival_ns)
    return newest


def stale_topics(topics: tuple[str, ...], robot: str, arrivals: Mapping[str, int], now_ns: int) -> tuple[str, ...]:
    """Those of `topics` that are older than their limit in the table, or have never arrived."""
    return tuple(t for t in topics if _is_stale(t, arrivals.get(key_of(t, robot)), now_ns))


def _is_stale(topic: str, arrival_ns: int | None, now_ns: int) -> bool:
    limit_s = TOPICS[topic].fresh_s
    if limit_s is None:
        return False
    return arrival_ns is None or now_ns - arrival_ns > limit_s * 1e9
