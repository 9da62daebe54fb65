"""A copy with scenes is whole, or there is none."""

from __future__ import annotations

from pathlib import Path

import pytest

from tailor.runtime.recordings.mcap import channel_table
from tailor.schemas.errors import UsageError
from tailor.tools.scenes.recorded_scenes import add_scenes

GOLDEN = "tests/data/golden/soccer-approach.mcap"


def test_a_copy_that_has_no_room_for_a_key_is_refused_and_removed(monkeypatch, tmp_path):
    monkeypatch.setattr(channel_table, "MAX_KEYS", 5)
    with pytest.raises(UsageError, match=": no room for "):
        add_scenes(Path(GOLDEN), tmp_path / "scenes.mcap")
    assert not list(tmp_path.iterdir())
