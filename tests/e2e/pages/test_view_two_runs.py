"""A recording of two runs, with nothing between them: what holds of one is not shown of the other, nor between them."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tailor.schemas import messages as m
from tailor.tools.viewer.page import page
from tailor.tools.viewer.timeline import RunTimeline
from tests.support import synthetic_run
from tests.support.browser import PROGRAM, Browser

pytestmark = [
    pytest.mark.skipif(PROGRAM is None, reason="no chromium here: install Debian's package chromium"),
    pytest.mark.xdist_group("browser"),
]
LATER_S = 30.0  # the second run


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with Browser() as opened:
        yield opened


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    timeline, events = RunTimeline(), []
    for later_s, seed in ((0.0, 3), (LATER_S, 4)):
        for t in synthetic_run.soccer_run(seed):
            events += timeline.events_of(later_s + t.time_ns / 1e9, t.key, t.message)
            if isinstance(t.message, m.ExecStatus):
                driver = m.DriverState(0, "armed", "", "", 7, synthetic_run.SENDER, 1)
                events += timeline.events_of(later_s + t.time_ns / 1e9, "agilo/driver", driver)
    path = tmp_path_factory.mktemp("runs") / "two.html"
    path.write_text(page("two", events))
    return path.as_uri()


def show(browser: Browser, address: str, at_s: float) -> None:
    browser.errors.clear()
    browser.send("Page.navigate", url="about:blank")
    browser.open(f"{address}#t={at_s}")
    browser.frame()


@pytest.mark.parametrize(("at_s", "seed"), [(0.0, 3), (5.0, 3), (LATER_S + 5.0, 4)])
def test_the_heading_names_the_run_of_the_shown_moment(browser: Browser, address: str, at_s, seed) -> None:
    show(browser, address, at_s)
    assert browser.value("document.querySelector('#heading .facts').textContent").endswith(f"seed {seed}")
    assert browser.errors == []


@pytest.mark.parametrize(("at_s", "silent"), [(5.0, False), (20.0, True), (LATER_S + 5.0, False)])
def test_between_the_runs_executive_and_driver_are_silent(browser: Browser, address: str, at_s, silent) -> None:
    show(browser, address, at_s)
    words = browser.value("document.querySelector('#heading .gone').textContent")
    assert [part in words for part in ("executive silent for", "driver silent for")] == [silent] * 2


@pytest.mark.parametrize("lane", ["speed", "checks"])
def test_no_curve_leads_from_one_run_to_the_other(browser: Browser, address: str, lane: str) -> None:
    show(browser, address, 5.0)
    path = browser.value(f"document.querySelector('[data-lane={lane}] .trace').getAttribute('d')")
    xs = [[float(point.split()[0]) for point in piece.split("L")] for piece in path.split("M")[1:]]
    assert len(xs) == 2
    assert xs[1][0] - xs[0][-1] > 200, "pixels of the timeline"
