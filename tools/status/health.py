"""Judges a system: healthy if all parts are there, alive, on time and able to move as soon as they are armed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import StrEnum

from tailor.schemas.reason_text import reason_text
from tailor.tools.status.picture import DriverView, ExecutiveView, Finding, ForeignView, LauncherView, TopicView
from tailor.tools.status.reading import topic_by_ending


class Problem(StrEnum):
    """What keeps a system from being healthy; docs/reasons.md lists them."""

    NO_DRIVER = "no driver"
    DRIVER_SILENT = "driver silent"
    DRIVER_STOPPED = "driver stopped"
    ESTOP_LATCHED = "e-stop latched"
    OBEYS_UNKNOWN = "driver obeys unknown sender"
    NO_EXECUTIVE = "no executive"
    SEVERAL_EXECUTIVES = "several executives"
    EXECUTIVE_SILENT = "executive silent"
    EXECUTIVE_HOLDS = "executive holds"
    EXECUTIVE_FAULT = "executive fault"
    TICKS_SKIPPED = "ticks skipped"
    LAUNCHER_SILENT = "launcher silent"
    PROCESS_NOT_RUNNING = "process not running"
    PROCESS_LACKS = "process lacks something"
    TOPIC_MISSING = "topic missing"
    TOPIC_STALE = "topic stale"
    TOPIC_SLOW = "topic slow"
    SEVERAL_SENDERS = "several senders"
    MESSAGES_REFUSED = "messages refused"
    OBSERVER_BEHIND = "observer behind"


Found = Iterator[tuple[Problem, str]]


def findings(
    executives: Sequence[ExecutiveView],
    drivers: Sequence[DriverView],
    launcher: LauncherView | None,
    topics: Sequence[TopicView],
    foreign: ForeignView,
    observed_s: float,
) -> tuple[Finding, ...]:
    """All problems; a disarmed robot and an idle or failed task are none."""
    found = [*_of_drivers(drivers), *_of_executives(executives)]
    found += [] if launcher is None else _of_launcher(launcher)
    found += [*_of_missing(executives, topics, observed_s), *_of_topics(topics), *_of_foreign(foreign)]
    return tuple(Finding(problem.value, detail) for problem, detail in found)


def _of_drivers(drivers: Sequence[DriverView]) -> Found:
    if not drivers:
        yield Problem.NO_DRIVER, "nothing publishes the state of a driver"
    for driver in drivers:
        if driver.silent:
            yield Problem.DRIVER_SILENT, f"{driver.robot} for {driver.age_s:.1f} s"
        elif driver.mode == "stopped":
            yield Problem.DRIVER_STOPPED, f"{driver.robot}: {reason_text(driver.reason, driver.detail)}"
        elif driver.mode == "estopped":
            yield Problem.ESTOP_LATCHED, driver.robot
        elif driver.armed_for == "absent":
            yield Problem.OBEYS_UNKNOWN, f"{driver.robot} obeys {driver.armed_sender[:8]}"


def _of_executives(executives: Sequence[ExecutiveView]) -> Found:
    if not executives:
        yield Problem.NO_EXECUTIVE, "nothing publishes the status of an executive"
    elif all(executive.silent for executive in executives):
        yield Problem.EXECUTIVE_SILENT, f"for {executives[0].age_s:.1f} s"
    alive = [executive for executive in executives if not executive.silent]
    if len(alive) > 1:
        yield Problem.SEVERAL_EXECUTIVES, ", ".join(executive.sender[:8] or "unsigned" for executive in alive)
    for executive in alive:
        reason = reason_text(executive.reason, executive.detail)
        if executive.mode == "HOLDING":
            yield Problem.EXECUTIVE_HOLDS, reason
        elif executive.mode == "FAULT":
            yield Problem.EXECUTIVE_FAULT, reason
        if executive.ticks is not None and executive.ticks.skipped:
            yield Problem.TICKS_SKIPPED, f"{executive.ticks.skipped} within the last minute"


def _of_launcher(launcher: LauncherView) -> Found:
    if launcher.silent:
        yield Problem.LAUNCHER_SILENT, f"for {launcher.age_s:.1f} s"
        return
    for process in launcher.processes:
        if process.state != "running":
            yield Problem.PROCESS_NOT_RUNNING, f"{process.name} is {process.state} after {process.starts} starts"
        if process.status:
            yield Problem.PROCESS_LACKS, f"{process.name}: {process.status}"


def _of_missing(executives: Sequence[ExecutiveView], topics: Sequence[TopicView], observed_s: float) -> Found:
    """What an executive requires and nobody has published; one that waits for a goal or a person reports it nowhere."""
    received = {topic.key for topic in topics}
    required = {key for executive in executives if not executive.silent for key in executive.required}
    for key in sorted(required - received):
        topic = topic_by_ending(key)
        if topic is not None and topic.fresh_s is not None and observed_s > topic.fresh_s:
            yield Problem.TOPIC_MISSING, f"{key}, required, not received in {observed_s:.1f} s"


def _of_topics(topics: Sequence[TopicView]) -> Found:
    for topic in topics:
        if topic.stale:
            yield Problem.TOPIC_STALE, f"{topic.key} for {topic.age_s:.1f} s"
        elif topic.slow:
            yield Problem.TOPIC_SLOW, f"{topic.key} at {topic.rate_hz:.1f} of {topic.nominal_hz:g} Hz"
        if topic.senders > 1 and topic.nominal_hz > 0:
            yield Problem.SEVERAL_SENDERS, f"{topic.senders} publish {topic.key}"


def _of_foreign(foreign: ForeignView) -> Found:
    for key, reasons in foreign.refused.items():
        yield Problem.MESSAGES_REFUSED, f"{key}: " + ", ".join(f"{count} {why}" for why, count in reasons.items())
    if foreign.dropped:
        yield Problem.OBSERVER_BEHIND, f"{foreign.dropped} messages dropped by this observer"
