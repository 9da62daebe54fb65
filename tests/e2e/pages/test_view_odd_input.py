"""What no page expects: joints that not every message names, an address that names no time."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tailor.schemas import messages as m
from tailor.tools.viewer.page import page
from tailor.tools.viewer.timeline import Event, RunTimeline
from tests.support.browser import PROGRAM, Browser

pytestmark = [
    pytest.mark.skipif(PROGRAM is None, reason="no chromium here: install Debian's package chromium"),
    pytest.mark.xdist_group("browser"),
]
DRIVEN = [(0.1 * i, 0.02 * i) for i in range(20)]


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with Browser() as opened:
        yield opened


def show(browser: Browser, path: Path, events: list[Event], address: str = "") -> None:
    path.write_text(page(path.stem, events))
    browser.errors.clear()
    browser.send("Page.navigate", url="about:blank")
    browser.open(path.as_uri() + address)
    browser.frame()


def truth(places: list[tuple[float, float]]) -> list[Event]:
    return [
        Event(0.1 * i, "truth", {"x": x, "y": y, "phi": 0.0, "v": 0.2, "index": -1}) for i, (x, y) in enumerate(places)
    ]


def joints(at_s: float, **positions: float) -> tuple[float, str, m.Message]:
    return at_s, "arm/joints", m.JointState(0, tuple(positions), tuple(positions.values()), (), ())


def test_joints_of_several_publishers_each_have_a_whole_curve(browser: Browser, tmp_path: Path) -> None:
    """The names of the first message were those of all: others had no curve, or one that ended there."""
    both = [each for i in range(10) for each in (joints(0.2 * i, left=0.1 * i), joints(0.2 * i + 0.1, right=-0.1 * i))]
    timeline = RunTimeline()
    show(browser, tmp_path / "joints.html", [event for each in both for event in timeline.events_of(*each)])
    lines = "[...document.querySelectorAll('#scene .plots .trace')].map((e) => e.getAttribute('d').split('L').length)"
    assert browser.value(lines) == [10, 10]
    assert browser.value("[...document.querySelectorAll('#scene .plots .strong')].map((e) => e.textContent)") == [
        "joints positions left",
        "joints positions right",
    ]
    assert browser.errors == []


@pytest.mark.parametrize("counts", [(2, 1), (1, 2)])
def test_beliefs_of_runs_that_believe_more_or_less_are_each_drawn(browser: Browser, tmp_path: Path, counts) -> None:
    """The page stood still where a second run has fewer values; where it has more, only the first ones were drawn."""
    believed = [{"elapsed": 0.0, "predicted": 1.0, "values": [0.1 * i] * counts[i // 10]} for i in range(20)]
    show(browser, tmp_path / "beliefs.html", [Event(0.1 * i, "belief", each) for i, each in enumerate(believed)])
    assert browser.value("document.querySelectorAll('#scene .plots .trace').length") == 2
    assert browser.value("document.querySelector('output').textContent") == "1.9 of 1.9 s"
    assert browser.errors == []


@pytest.mark.parametrize(("address", "shown_s"), [("#t=.5", 0.5), ("#t=1.2.3", 1.9), ("#t=.", 1.9), ("#t=-3", 0.0)])
def test_an_address_that_names_no_time_opens_at_the_end(browser: Browser, tmp_path: Path, address, shown_s) -> None:
    show(browser, tmp_path / "driven.html", truth(DRIVEN), address)
    assert browser.value("Number(document.documentElement.dataset.at)") == pytest.approx(shown_s)
