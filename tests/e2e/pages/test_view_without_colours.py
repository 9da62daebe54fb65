"""What a page tells by colours it tells by shapes too, and to who hears it by words."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tailor.tools.viewer.page import page
from tailor.tools.viewer.timeline import RunTimeline
from tests.support import synthetic_run
from tests.support.browser import PROGRAM, Browser

pytestmark = [
    pytest.mark.skipif(PROGRAM is None, reason="no chromium here: install Debian's package chromium"),
    pytest.mark.xdist_group("browser"),
]


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with Browser() as opened:
        yield opened


def show(browser: Browser, path: Path, run, at_s: float) -> None:
    timeline = RunTimeline()
    events = [event for t in run for event in timeline.events_of(t.time_ns / 1e9, t.key, t.message)]
    path.write_text(page(path.stem, events))
    browser.errors.clear()
    browser.send("Page.navigate", url="about:blank")
    browser.open(f"{path.as_uri()}#t={at_s}")
    browser.frame()


def test_a_failed_action_has_a_cross_and_an_aborted_one_a_dashed_border(browser: Browser, tmp_path: Path) -> None:
    run = synthetic_run.arm_run(outcomes=("failed", "aborted", "done", "done"))
    show(browser, tmp_path / "arm.html", run, 6.0)
    actions = "[...document.querySelectorAll('#timeline g:has(> .bar.actual)')]"
    crosses = browser.value(f"{actions}.map((each) => each.querySelectorAll('.cross').length)")
    dashes = browser.value(f"{actions}.map((e) => getComputedStyle(e.querySelector('.actual')).strokeDasharray)")
    assert crosses == [1, 0, 0, 0]
    assert [dash != "none" for dash in dashes] == [False, True, False, False]
    assert browser.errors == []


def test_steps_of_a_plan_that_are_done_or_running_have_their_signs_and_words(browser: Browser, tmp_path: Path) -> None:
    show(browser, tmp_path / "soccer.html", synthetic_run.soccer_run(), 8.0)
    signs = (
        "[...document.querySelectorAll('#plan .node')].map((e) => e.querySelector('.sign')?.getAttribute('d') ?? '')"
    )
    initial, done, running, goal = browser.value(signs)
    assert (initial, goal) == ("", "")
    assert len({each.partition("m")[2] for each in ("", done, running)}) == 3
    nodes = browser.send("Accessibility.getFullAXTree")["nodes"]
    words = next(w for node in nodes if (w := node.get("name", {}).get("value", "")).startswith("the plan's steps"))
    assert words.endswith("initial state; approachball pos1 pos2, done; dribbleball pos2 pos3, running; goal")
    assert browser.errors == []
