"""Converts a recording into the events that its page shows."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from tailor.runtime.recordings.mcap.scan import DamageReport
from tailor.schemas.messages import Odometry, PoseEstimate
from tailor.tools.recordings.damage_notice import notice
from tailor.tools.viewer.timed_messages import Timed, timed
from tailor.tools.viewer.timeline import Event, RunTimeline

DAMAGE = "damage"  # kind of the event that states the damage of a recording
BETTER = ("truth", "believed")  # sources of the robot's pose; with one of them the page draws no other
SENSED = (Odometry, PoseEstimate)  # the others: most of a recording's messages, and the slowest to decode


def recorded_events(path: Path, timeline: RunTimeline, sender: str = "") -> Iterator[Event]:
    """All events of a recording that the page shows, on a time axis that starts with the first message.

    The damage of a damaged one is the last event, at the start of the axis.

    Raises:
      UsageError: See `timed`; the robot is that which the timeline is to show.
    """
    robot, damage = timeline.robot, DamageReport(complete=True)
    trial = RunTimeline(robot=robot)

    def note(found: DamageReport) -> None:
        nonlocal damage
        damage = found

    better = any(event.kind in BETTER for t in timed(path, sender, SENSED) for event in _events_of(t, trial))
    for t in timed(path, sender, SENSED if better else (), note, robot):
        yield from _events_of(t, timeline)
    if text := notice(path, damage):
        yield Event(0.0, DAMAGE, {"text": text})


def _events_of(t: Timed, timeline: RunTimeline) -> list[Event]:
    return timeline.events_of(max(0.0, t.at_s), t.key, t.message)
