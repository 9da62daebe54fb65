"""Runs beside one another in a real headless browser: one player, one moment, panels of one height."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tailor.tools.viewer.side_by_side import side_by_side
from tailor.tools.viewer.timeline import Event, RunTimeline
from tests.support import synthetic_run
from tests.support.browser import PROGRAM, Browser

pytestmark = [
    pytest.mark.skipif(PROGRAM is None, reason="no chromium here: install Debian's package chromium"),
    pytest.mark.xdist_group("browser"),
]
AT = "Number(document.documentElement.dataset.at)"
LATER_S = 2.0  # the second run begins later in its recording
FRAMES_AT = """[...document.querySelectorAll('iframe')]
  .map((frame) => Number(frame.contentDocument.documentElement.dataset.at))"""
SCENES_TOP = """[...document.querySelectorAll('iframe')]
  .map((frame) => frame.contentDocument.getElementById('scene').getBoundingClientRect().top)"""


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with Browser() as opened:
        yield opened


@pytest.fixture
def runs(tmp_path: Path) -> str:
    """Address of a page of the same run twice, the second time later in its recording."""
    timeline = RunTimeline()
    rows = [row for t in synthetic_run.soccer_run() for row in timeline.events_of(t.time_ns / 1e9, t.key, t.message)]
    later = [Event(row.at_s + LATER_S, row.kind, row.fields) for row in rows]
    path = tmp_path / "runs.html"
    path.write_text(side_by_side("runs", "9 % less", {"greedy": rows, "refined": later}))
    return path.as_uri()


def test_runs_side_by_side_move_in_step(browser: Browser, runs: str) -> None:
    """Time counts from each run's first action, wherever it starts in its recording."""
    browser.open(runs)
    browser.wait(f"{AT} === 0")
    browser.wait(f"{FRAMES_AT}.every((at) => at > 0)")
    first, second = browser.value(FRAMES_AT)
    assert second == pytest.approx(first + LATER_S)
    browser.press("ArrowRight", shift=True)
    browser.wait(f"{FRAMES_AT}[0] > {first} + 0.9")
    assert browser.value(FRAMES_AT) == pytest.approx([first + 1, second + 1])
    inside = "document.querySelectorAll('iframe')[1].contentDocument"
    words = f"[...{inside}.querySelectorAll('#scene .numbers text')].map((e) => e.getBoundingClientRect().height)"
    assert browser.value(f"Math.min(...{words})") > 9, "legible, though the panel is wider than the drawing"
    browser.value(f"{inside}.dispatchEvent(new KeyboardEvent('keydown', {{key: 'Home'}}))")
    browser.wait(f"{AT} < 0.01")
    assert browser.errors == []


def test_the_address_names_the_moment_of_all_runs(browser: Browser, runs: str) -> None:
    browser.send("Page.navigate", url="about:blank")
    browser.open(f"{runs}#t=1.5")
    browser.wait(f"{AT} === 1.5")
    browser.wait(f"Math.abs({FRAMES_AT}[1] - {FRAMES_AT}[0] - {LATER_S}) < 0.01")


def test_panels_begin_at_one_height_however_long_a_title_is(browser: Browser, runs: str) -> None:
    browser.resize(1440, 900)
    browser.send("Page.navigate", url="about:blank")
    browser.open(f"{runs}#t=1.5")
    heading = "document.querySelector('iframe').contentDocument.querySelector('{}')"
    browser.value(f"{heading.format('h1')}.append('a recording with a long name '.repeat(5))")
    browser.value(f"{heading.format('.now')}.append(' disarmed: driver not armed'.repeat(5))")
    browser.frame()
    first, second = browser.value(SCENES_TOP)
    assert first == second
    browser.send("Emulation.clearDeviceMetricsOverride")
