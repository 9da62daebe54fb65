"""A copy with scenes is whole, or there is none."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tailor.runtime.recordings.mcap import channel_table
from tailor.runtime.recordings.recording import Recording
from tailor.schemas.errors import UsageError
from tailor.tools.scenes.recorded_scenes import add_scenes

GOLDEN = "tests/data/golden/soccer-approach.mcap"


def test_a_copy_that_has_no_room_for_a_key_is_refused_and_removed(monkeypatch, tmp_path):
    monkeypatch.setattr(channel_table, "MAX_KEYS", 5)
    with pytest.raises(UsageError, match=": no room for "):
        add_scenes(Path(GOLDEN), tmp_path / "scenes.mcap")
    assert not list(tmp_path.iterdir())


def test_a_recording_of_a_recorder_with_a_clock_beyond_the_bus_gets_its_scenes(monkeypatch, tmp_path):
    messages = Recording.messages
    late = {"log_ns": 2**64 - 1}  # the last moment that a recording can name
    monkeypatch.setattr(Recording, "messages", lambda self: (replace(each, **late) for each in messages(self)))
    added, *_ = add_scenes(Path(GOLDEN), tmp_path / "scenes.mcap")
    assert added > 0
