"""A track out of a recording."""

from __future__ import annotations

from pathlib import Path

from runtime.recording import open_recording
from schemas.errors import Rejected
from tools.figures.track import Track, track_of


def recorded_track(title: str, path: Path) -> Track:
    """Read a recording; raises UsageError if it is none."""
    recording = open_recording(path)
    return track_of(title, (message for _, message in recording.decoded() if not isinstance(message, Rejected)))
