"""Converts a recording into the events that its page shows."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from tailor.runtime.recordings.mcap.scan import DamageReport
from tailor.schemas.messages import ExecStatus, Odometry, PoseEstimate
from tailor.tools.recordings.damage_notice import notice
from tailor.tools.viewer.timed_messages import Timed, several_executives, timed
from tailor.tools.viewer.timeline import Event, RunTimeline

NOTICE = "damage"  # kind of the event that states what a reader of the page must know of the recording
BETTER = ("truth", "believed")  # sources of the robot's pose; with one of them the page draws no other
SENSED = (Odometry, PoseEstimate)  # the others: most of a recording's messages, and the slowest to decode


def recorded_events(path: Path, timeline: RunTimeline, sender: str = "") -> Iterator[Event]:
    """All events of a recording that the page shows, on a time axis that starts with the first message.

    That it is damaged, or holds the runs of several executives, is the last event, at the start of the axis.

    Raises:
      UsageError: See `timed`; the robot is that which the timeline is to show.
    """
    robot, damage = timeline.robot, DamageReport(complete=True)
    trial, executives = RunTimeline(robot=robot), dict[str, float]()

    def note(found: DamageReport) -> None:
        nonlocal damage
        damage = found

    better = any(event.kind in BETTER for t in timed(path, sender, SENSED) for event in _events_of(t, trial))
    for t in timed(path, sender, SENSED if better else (), note, robot):
        if isinstance(t.message, ExecStatus):
            executives.setdefault(t.sender, t.at_s)
        yield from _events_of(t, timeline)
    notices = notice(path, damage), several_executives(path, executives, "runs")
    if text := "; ".join(filter(None, notices)):
        yield Event(0.0, NOTICE, {"text": text})


def _events_of(t: Timed, timeline: RunTimeline) -> list[Event]:
    return timeline.events_of(max(0.0, t.at_s), t.key, t.message)
