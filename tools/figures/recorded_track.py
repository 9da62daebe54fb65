"""A track out of a recording."""

from __future__ import annotations

from pathlib import Path

from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import Provenance
from tailor.tools.figures.track import Track, track_of
from tailor.tools.recordings.damage_notice import warn
from tailor.tools.scenes.scene_feed import domain_of


def recorded_track(title: str, path: Path) -> Track:
    """Read a recording; raises UsageError if it is none."""
    recording = open_recording(path)
    messages = [message for _, message in recording.decoded() if not isinstance(message, Rejected)]
    warn(path, recording.damage)
    domains = (domain_of(message) for message in messages if isinstance(message, Provenance))
    return track_of(title, messages, next(domains, ""))
