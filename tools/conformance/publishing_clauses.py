"""Clauses that concern what a driver publishes while it stands."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from tailor.schemas.messages import DriverState
from tailor.schemas.topics import TOPICS
from tailor.tools.conformance.bench import Bench
from tailor.tools.conformance.clause import clause
from tailor.tools.conformance.link import Heard

LISTEN_S = 3.0
MIN_STATE_HZ = 7.0  # of 10 Hz
MODES = ("disarmed", "armed", "stopped", "estopped")
LEAST, MOST = 0.6, 1.5  # of a declared rate


@clause
def reports_its_state(bench: Bench) -> Iterator[str]:
    """The driver publishes its state ten times a second, with a known mode and an epoch that is not 0."""
    states = [each.message for each in _listened(bench, "driver") if isinstance(each.message, DriverState)]
    if len(states) < MIN_STATE_HZ * LISTEN_S:
        yield f"{len(states)} states in {LISTEN_S:g} s, expected 30"
    for state in states[-1:]:
        if state.mode not in MODES:
            yield f"mode is '{state.mode}', expected one of: {', '.join(MODES)}"
        if state.epoch == 0:
            yield "epoch is 0, which stands for any epoch"


@clause
def keeps_its_rates(bench: Bench) -> Iterator[str]:
    """Each sensor that the domain requires comes at its rate in driver.toml, or a simulator's at that of its topic."""
    since_s = _listen(bench)
    for sensor in bench.spec.sensors:
        rate_hz = sensor.nominal_hz
        if sensor.topic not in bench.domain.required or not rate_hz:
            continue
        found_hz = len(bench.heard(sensor.topic, since_s)) / LISTEN_S
        if not LEAST * rate_hz <= found_hz <= MOST * max(rate_hz, TOPICS[sensor.topic].rate_hz):
            yield f"{sensor.topic} comes at {found_hz:.1f} Hz, declared are {rate_hz:g} Hz"


@clause
def keeps_its_frames(bench: Bench) -> Iterator[str]:
    """Headers of sensors name the frames that driver.toml declares (REP-105)."""
    since_s = _listen(bench)
    for sensor in bench.spec.sensors:
        frames = {each.frame for each in bench.heard(sensor.topic, since_s)}
        if sensor.frame and frames - {sensor.frame}:
            found = ", ".join(sorted(frames - {sensor.frame})) or "none"
            yield f"{sensor.topic} is in the frame '{found}', declared is '{sensor.frame}'"


@clause
def publishes_no_stale_data(bench: Bench) -> Iterator[str]:
    """No measurement is published twice: a sensor's stamps rise, where its messages have any, and so do its numbers."""
    since_s = _listen(bench)
    for sensor in bench.spec.sensors:
        heard = bench.heard(sensor.topic, since_s)
        stamps = [each.message.stamp_ns for each in heard if hasattr(each.message, "stamp_ns")]
        if any(later <= earlier for earlier, later in pairwise(stamps)):
            yield f"{sensor.topic}: a stamp does not rise: an old measurement was published again"
        numbers = [each.sequence for each in heard]
        if any(later <= earlier for earlier, later in pairwise(numbers)):
            yield f"{sensor.topic}: a sequence number does not rise"


@clause
def is_one_start(bench: Bench) -> Iterator[str]:
    """State and sensors come from one sender, and the epoch stays the same while the driver runs."""
    _listen(bench)
    known = {"driver", *(sensor.topic for sensor in bench.spec.sensors)}
    senders = {each.sender for each in bench.log if each.topic in known}
    if len(senders) > 1:
        yield f"messages come from {len(senders)} senders, expected one"
    epochs = {each.message.epoch for each in bench.log if isinstance(each.message, DriverState)}
    if len(epochs) > 1:
        yield f"the epoch changed {len(epochs) - 1} times, expected only at a start of the driver"


def _listen(bench: Bench) -> float:
    since_s = bench.link.now_s()
    bench.wait(LISTEN_S)
    return since_s


def _listened(bench: Bench, topic: str) -> list[Heard]:
    return bench.heard(topic, _listen(bench))
