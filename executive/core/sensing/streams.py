"""Where the samples of a sensor come from, and how many: one sender counts, and its numbers give its rate."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tailor.executive.core.sensing.freshness import is_stale
from tailor.schemas.messages import Sample
from tailor.schemas.topics import key_of

RATE_WINDOW_NS = 1_000_000_000
SILENT_S = 1.0  # of the known sender of a topic without a limit of freshness: then another one counts
MIN_RATE = 0.6  # of the nominal rate; half the rate is below it, a stall of 0.3 s in a second is above


@dataclass(frozen=True, slots=True)
class Stream:
    """Samples of one key from one sender in the last second, and the newest one before: (arrival in ns, number)."""

    sender: str
    samples: tuple[tuple[int, int], ...]


def of_known_senders(
    topics: tuple[str, ...], robot: str, streams: Mapping[str, Stream], samples: tuple[Sample, ...]
) -> tuple[Sample, ...]:
    """The samples of `topics`, without those of a second sender of one, e.g. of a simulator that was started twice.

    It counts once the known sender is silent, e.g. after a restart: two places of one robot make no belief, and what
    one of them sees is not where the other one stands.
    """
    keys = {key_of(topic, robot): topic for topic in topics}
    known = {key: (stream.sender, stream.samples[-1][0]) for key, stream in streams.items()}
    kept = []
    for sample in samples:
        topic = keys.get(sample.key)
        if topic is None:
            continue
        sender, heard_ns = known.get(sample.key, (sample.sender, sample.arrival_ns))
        if sample.sender == sender or is_stale(topic, heard_ns, sample.arrival_ns, SILENT_S):
            known[sample.key] = (sample.sender, sample.arrival_ns)
            kept.append(sample)
    return tuple(kept)


def with_samples(streams: Mapping[str, Stream], samples: tuple[Sample, ...], now_ns: int) -> dict[str, Stream]:
    """Streams by key, `samples` included; another sender, or a number that does not rise, begins a new one."""
    following = dict(streams)
    for sample in samples:
        stream = following.get(sample.key)
        known = stream.samples if stream is not None and stream.sender == sample.sender else ()
        if known and sample.sequence <= known[-1][1]:
            known = ()
        following[sample.key] = Stream(sample.sender, (*known, (sample.arrival_ns, sample.sequence)))
    return {key: _without_old(stream, now_ns - RATE_WINDOW_NS) for key, stream in following.items()}


def slow_topics(
    nominal_hz: Mapping[str, float], robot: str, streams: Mapping[str, Stream], now_ns: int
) -> tuple[str, ...]:
    """Topics that come at less than 60 % of their nominal rate, as text, e.g. "odom at 25 of 50 Hz".

    A tick receives only the newest sample of a topic; the sender's sequence numbers show how many there were. A topic
    without numbers, or with less than a second of history, is not judged.
    """
    rates_hz = {topic: _rate_hz(streams.get(key_of(topic, robot)), now_ns) for topic in nominal_hz}
    return tuple(
        f"{topic} at {rate_hz:.0f} of {nominal_hz[topic]:g} Hz"
        for topic, rate_hz in rates_hz.items()
        if rate_hz is not None and rate_hz < MIN_RATE * nominal_hz[topic]
    )


def _without_old(stream: Stream, since_ns: int) -> Stream:
    """The stream without all but the newest of the samples that arrived until `since_ns`."""
    old = sum(arrival_ns <= since_ns for arrival_ns, _ in stream.samples)
    return Stream(stream.sender, stream.samples[old - 1 :]) if old > 1 else stream


def _rate_hz(stream: Stream | None, now_ns: int) -> float | None:
    if stream is None:
        return None
    (first_ns, first), (last_ns, last) = stream.samples[0], stream.samples[-1]
    if now_ns - first_ns < RATE_WINDOW_NS or last_ns <= first_ns:  # too short, or ceased: then its age counts
        return None
    return (last - first) * 1e9 / (last_ns - first_ns)
