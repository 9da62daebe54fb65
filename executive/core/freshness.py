"""Age and rate of every input by the receiver's clock; a sender's stamp never makes data fresher."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tailor.schemas.messages import DriverState, Sample
from tailor.schemas.topics import TOPICS, key_of

RATE_WINDOW_NS = 1_000_000_000
MAX_ROUND_TRIP_NS = 750_000_000  # 300 ms each way, a period of the driver state, and 50 ms; below 800 ms one way
SILENT_S = 1.0  # of the known sender of a topic without a limit of freshness: then another one counts
MIN_RATE = 0.6  # of the nominal rate; half the rate is below it, a stall of 0.3 s in a second is above


@dataclass(frozen=True, slots=True)
class Stream:
    """Samples of one key from one sender in the last second, and the newest one before: (arrival in ns, number)."""

    sender: str
    samples: tuple[tuple[int, int], ...]


def newest_arrivals(arrivals: Mapping[str, int], samples: tuple[Sample, ...]) -> dict[str, int]:
    """Newest arrival in ns by key, `samples` included."""
    newest = dict(arrivals)
    for sample in samples:
        newest[sample.key] = max(newest.get(sample.key, sample.arrival_ns), sample.arrival_ns)
    return newest


def stale_topics(topics: tuple[str, ...], robot: str, arrivals: Mapping[str, int], now_ns: int) -> tuple[str, ...]:
    """Those of `topics` that are older than their limit in the table, or have never arrived."""
    return tuple(t for t in topics if _is_stale(t, arrivals.get(key_of(t, robot)), now_ns))


def echo_age_ns(state: DriverState, arrival_ns: int, stamp_offset_ns: int) -> int:
    """Age in ns of the newest command that a driver's state echoes, as the state arrives; 0 without one.

    Both times come from this executive's clock. The age includes both ways and up to a period of the driver state.
    """
    return arrival_ns + stamp_offset_ns - state.command_stamp_ns if state.command_stamp_ns else 0


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


def of_known_senders(
    topics: tuple[str, ...], robot: str, streams: Mapping[str, Stream], samples: tuple[Sample, ...]
) -> tuple[Sample, ...]:
    """The samples without those of a second sender of one of `topics`, e.g. of a simulator that was started twice.

    It counts once the known sender is silent, e.g. after a restart: two places of one robot make no belief, and what
    one of them sees is not where the other one stands.
    """
    keys = {key_of(topic, robot): topic for topic in topics}
    known = {key: (stream.sender, stream.samples[-1][0]) for key, stream in streams.items()}
    kept = []
    for sample in samples:
        topic = keys.get(sample.key)
        sender, arrival_ns = known.get(sample.key, (sample.sender, sample.arrival_ns))
        if topic is None or sample.sender == sender or _is_silent(topic, arrival_ns, sample.arrival_ns):
            known[sample.key] = (sample.sender, sample.arrival_ns)
            kept.append(sample)
    return tuple(kept)


def slow_topics(
    topics: tuple[str, ...], robot: str, streams: Mapping[str, Stream], now_ns: int, rates_hz: Mapping[str, float]
) -> tuple[str, ...]:
    """Those of `topics` that come at less than 60 % of their nominal rate, as text, e.g. "odom at 25 of 50 Hz".

    The nominal rate is that in `rates_hz`, by topic, or else that of the table of topics. A tick receives only the
    newest sample of a topic; the sender's sequence numbers show how many there were. A topic without numbers, or with
    less than a second of history, is not judged.
    """
    rates = ((topic, _rate_hz(streams.get(key_of(topic, robot)), now_ns)) for topic in topics)
    nominal = {topic: rates_hz.get(topic, TOPICS[topic].rate_hz) for topic in topics}
    return tuple(
        f"{topic} at {rate:.0f} of {nominal[topic]:g} Hz"
        for topic, rate in rates
        if rate is not None and rate < MIN_RATE * nominal[topic]
    )


def _is_stale(topic: str, arrival_ns: int | None, now_ns: int) -> bool:
    limit_s = TOPICS[topic].fresh_s
    if limit_s is None:
        return False
    return arrival_ns is None or now_ns - arrival_ns > limit_s * 1e9


def _is_silent(topic: str, arrival_ns: int, now_ns: int) -> bool:
    limit_s = TOPICS[topic].fresh_s or SILENT_S
    return now_ns - arrival_ns > limit_s * 1e9


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
