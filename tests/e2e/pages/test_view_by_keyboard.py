"""The space bar presses what has the focus, and plays a run only elsewhere: in a page and in one that frames others."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tailor.tools.viewer.page import page
from tailor.tools.viewer.side_by_side import side_by_side
from tailor.tools.viewer.timeline import Event, RunTimeline
from tests.support import synthetic_run
from tests.support.browser import PROGRAM, Browser

pytestmark = [
    pytest.mark.skipif(PROGRAM is None, reason="no chromium here: install Debian's package chromium"),
    pytest.mark.xdist_group("browser"),
]
PLAY = "document.querySelector('.play').textContent"


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with Browser() as opened:
        yield opened


@pytest.fixture
def rows() -> list[Event]:
    """Of an arm, whose page has a part that opens, with a joint that moves."""
    timeline = RunTimeline()
    events = [row for t in synthetic_run.arm_run() for row in timeline.events_of(t.time_ns / 1e9, t.key, t.message)]
    return [*events, *[Event(0.1 * i, "series joints", {"pan": 0.1 * i}) for i in range(10)]]


def show(browser: Browser, path: Path, text: str) -> None:
    path.write_text(text)
    browser.errors.clear()
    browser.send("Page.navigate", url="about:blank")
    browser.open(f"{path.as_uri()}#t=1")
    browser.frame()


@pytest.mark.parametrize(
    ("selector", "pressed"),
    [
        ("summary", "document.querySelector('details').open"),
        ("#plan .fold", "document.querySelector('#plan').classList.contains('folded')"),
    ],
)
def test_what_opens_and_folds_is_pressed_and_nothing_plays(browser: Browser, tmp_path, rows, selector, pressed) -> None:
    show(browser, tmp_path / "arm.html", page("arm", rows))
    browser.value(f"document.querySelector({selector!r}).focus()")
    browser.press(" ")
    assert (browser.value(pressed), browser.value(PLAY)) == (True, "▶")
    assert browser.errors == []


def test_a_framed_page_is_pressed_as_one_that_stands_alone(browser: Browser, tmp_path, rows) -> None:
    show(browser, tmp_path / "runs.html", side_by_side("runs", "", {"a": rows, "b": rows}))
    inside = "document.querySelector('iframe').contentDocument.querySelector('#plan{}')"
    browser.value(f"{inside.format(' .fold')}.focus()")
    browser.press(" ")
    assert browser.value(f"{inside.format('')}.classList.contains('folded')")
    assert browser.value(PLAY) == "▶"
    browser.value("document.activeElement.blur()")
    browser.press(" ")
    browser.wait(f"{PLAY} !== '▶'")
    assert browser.errors == []
