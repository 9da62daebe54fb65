"""Reads the messages of a recording with their times, and converts them into events."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.errors import Rejected, UsageError
from tailor.schemas.messages import Message
from tailor.tools.viewer.timeline import Event, RunTimeline

EXECUTIVE = "exec/"


@dataclass(frozen=True, slots=True)
class Timed:
    """A message with its key and its time of reception, seconds since the recording's first message."""

    at_s: float
    key: str
    message: Message


def timed(path: Path, sender: str = "") -> Iterator[Timed]:
    """Messages of a recording in the order of their reception, without damaged ones.

    Args:
      path: MCAP file.
      sender: Skip executives whose id does not begin with this.

    Raises:
      UsageError: The file is no recording, or has no readable message.
    """
    began_ns: int | None = None
    for recorded, message in open_recording(path).decoded():
        if isinstance(message, Rejected) or (
            recorded.key.startswith(EXECUTIVE) and not recorded.sender.startswith(sender)
        ):
            continue
        began_ns = recorded.log_ns if began_ns is None else began_ns
        yield Timed((recorded.log_ns - began_ns) / 1e9, recorded.key, message)
    if began_ns is None:
        raise UsageError(f"{path}: no readable message, expected a recording of a run")


def recorded_events(path: Path, timeline: RunTimeline, sender: str = "") -> list[Event]:
    """All events of a recording."""
    return [event for t in timed(path, sender) for event in timeline.events_of(max(0.0, t.at_s), t.key, t.message)]
