"""`tailor bench growth`: exponents of curves, which ones grow too fast, the long recording, the files written."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from tailor.runtime.recordings.recording import open_recording
from tailor.tools.benchmarks.growth import growth, recording
from tailor.tools.benchmarks.growth.curve import Curve

GOLDEN = Path("tests/data/golden/soccer-approach.mcap")
WORK = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0)


def curve(exponent, allowed=1.0, factor=0.3):
    return Curve("a cost", "work", "s", [(work, factor * work**exponent) for work in WORK], allowed)


@given(st.floats(-1.0, 4.0), st.floats(1e-3, 1e3))
def test_exponent_of_a_power_is_its_own(exponent, factor):
    assert curve(exponent, factor=factor).exponent == pytest.approx(exponent, abs=1e-6)


def test_overhead_of_small_work_does_not_hide_growth():
    points = [(work, 10.0 + work**2) for work in (1, 2, 4, 50, 100, 200, 400)]
    assert Curve("a cost", "work", "s", points, 1.0).too_fast


def test_one_point_has_no_exponent_and_is_written_as_json():
    fields = Curve("a cost", "work", "s", [(1.0, 2.0)], 1.0).fields()
    assert fields["exponent"] is None
    assert not fields["too_fast"]
    json.dumps(fields, allow_nan=False)


@pytest.mark.parametrize(("exponent", "too_fast"), [(0.0, False), (1.2, False), (1.3, True), (2.0, True)])
def test_what_grows_faster_than_allowed_is_named(exponent, too_fast):
    assert curve(exponent).too_fast == too_fast


def test_long_recording_is_as_long_as_wanted_and_repeats_every_message(tmp_path):
    path = tmp_path / "long.mcap"
    recording.concatenate([GOLDEN, GOLDEN], 1.0, path)
    part, whole = (list(open_recording(p).messages()) for p in (GOLDEN, path))
    seconds = (whole[-1].log_ns - whole[0].log_ns) / 1e9
    assert 60.0 - recording.PAUSE_NS / 1e9 <= seconds < 90.0
    assert len(whole) % len(part) == 0
    assert [m.data for m in whole[: len(part)]] == [m.data for m in part]
    assert np.all(np.diff([m.log_ns for m in whole]) >= 0)


def test_growth_writes_points_and_picture_and_names_what_grows_too_fast(monkeypatch, tmp_path):
    monkeypatch.setattr(growth, "PARTS", {"one": lambda quick: iter([curve(1.0), curve(2.0)])})
    console = Console(record=True, width=140)
    growth.run(console, True, tmp_path / "growth.json")
    rows = json.loads((tmp_path / "growth.json").read_text())
    assert [row["too_fast"] for row in rows] == [False, True]
    assert rows[0]["points"][0] == [1.0, 0.3]
    assert (tmp_path / "growth.png").read_bytes().startswith(b"\x89PNG")
    assert console.export_text().count("grows too fast") == 1
