"""A recording into rows, and into the messages that `tailor why` asks for."""

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
    """A message, and when it was received: seconds since the recording's first."""

    at_s: float
    key: str
    message: Message


def timed(path: Path, sender: str = "") -> Iterator[Timed]:
    """The messages of a recording in the order of their reception; damaged ones are left out.

    Args:
      path: MCAP file.
      sender: Leave out executives whose id does not begin with this.

    Raises:
      UsageError: No recording, or nothing in it that can be shown.
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
        raise UsageError(f"{path}: no message that can be shown, expected a recording of a run")


def recorded_events(path: Path, story: RunTimeline, sender: str = "") -> list[Event]:
    """All rows of a recording."""
    return [row for t in timed(path, sender) for row in story.tell(max(0.0, t.at_s), t.key, t.message)]
