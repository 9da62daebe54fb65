"""A track out of a recording."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from tailor.runtime.recordings.recording import Recording, open_recording
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import ExecStatus, Message, Provenance
from tailor.tools.cli.plain_text import plain
from tailor.tools.figures.track import READ, Track, track_of
from tailor.tools.recordings.damage_notice import warn
from tailor.tools.scenes.scene_feed import domain_of
from tailor.tools.viewer.timed_messages import EXECUTIVE, SHOWN_DIGITS


def recorded_track(title: str, path: Path) -> Track:
    """Read the first run of a recording in which an action runs; others are warned of.

    Raises:
      UsageError: The file is no recording.
    """
    recording = open_recording(path)
    executive, domain = _first_run(recording)
    others: set[str] = set()
    track = track_of(title, _messages(recording, executive, others), domain)
    warn(path, recording.damage)
    if others:
        drawn = f"the first one, of executive {str(executive)[:SHOWN_DIGITS]}, is drawn"
        print(f"{plain(path.name)} holds {1 + len(others)} runs: {drawn}", file=sys.stderr)
    return track


def _first_run(recording: Recording) -> tuple[str | None, str]:
    """Sender of the first status with an action, None if there is none; and its domain, else the first one that is."""
    domains: dict[str, str] = {}
    for recorded, message in recording.decoded((Provenance, ExecStatus)):
        if isinstance(message, Provenance):
            domains.setdefault(recorded.sender, domain_of(message))
        elif isinstance(message, ExecStatus) and message.action:
            return recorded.sender, domains.get(recorded.sender, next(iter(domains.values()), ""))
    return None, next(iter(domains.values()), "")


def _messages(recording: Recording, executive: str | None, others: set[str]) -> Iterator[Message]:
    """Messages of the run of an executive; `others` is filled with senders of others, in whose runs actions run."""
    speaks = True  # whether the last status was its own: else the robot moves by another
    for recorded, message in recording.decoded(READ):
        own = executive in (None, recorded.sender)
        if isinstance(message, ExecStatus):
            speaks = own
            if message.action and not own:
                others.add(recorded.sender)
        if not isinstance(message, Rejected) and (own if recorded.key.startswith(EXECUTIVE) else speaks):
            yield message
