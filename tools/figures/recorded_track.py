"""A track out of a recording."""

from __future__ import annotations

from pathlib import Path

from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import Provenance
from tailor.tools.figures.track import READ, Track, track_of
from tailor.tools.recordings.damage_notice import warn
from tailor.tools.scenes.scene_feed import domain_of


def recorded_track(title: str, path: Path) -> Track:
    """Read a recording; raises UsageError if it is none."""
    recording = open_recording(path)
    provenances = (each for _, each in recording.decoded((Provenance,)) if isinstance(each, Provenance))
    domain = next(map(domain_of, provenances), "")
    messages = (each for _, each in recording.decoded(READ) if not isinstance(each, Rejected))
    track = track_of(title, messages, domain)
    warn(path, recording.damage)
    return track
