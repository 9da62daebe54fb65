"""What is pressed, by pointer or space bar: also on a live page, which draws anew while the pointer is down."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tailor.tools.viewer.explainer import Explainer
from tailor.tools.viewer.live.broadcast import EventBroadcast
from tailor.tools.viewer.live.server import serving
from tailor.tools.viewer.page import page
from tailor.tools.viewer.recorded_events import recorded_events
from tailor.tools.viewer.side_by_side import side_by_side
from tailor.tools.viewer.timeline import Event, RunTimeline
from tests.support import synthetic_run
from tests.support.browser import PROGRAM, Browser
from tests.support.bus_system import ROOT

pytestmark = [
    pytest.mark.skipif(PROGRAM is None, reason="no chromium here: install Debian's package chromium"),
    pytest.mark.xdist_group("browser"),
]
DOWN_S = 0.12  # of a button of a mouse
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


@contextmanager
def live(browser: Browser, events: list[Event], more: Callable[[int], Event]) -> Iterator[None]:
    """A live page of a run that goes on: 20 more events a second."""
    broadcast, ended = EventBroadcast(), threading.Event()

    def feed() -> None:
        for number in range(100_000):
            broadcast.publish([more(number)])
            if ended.wait(0.05):
                return

    with serving(page("live", [], live=True), broadcast, 0) as port:
        browser.open(f"http://127.0.0.1:{port}/")
        broadcast.publish(events)
        feeder = threading.Thread(target=feed)
        feeder.start()
        try:
            yield
        finally:
            ended.set()
            feeder.join()
    browser.errors.clear()  # of the server that is gone


def middle(browser: Browser, selector: str) -> list[float]:
    """Where an element is in the window, once it is there."""
    element = f"document.querySelector({selector!r})"
    browser.wait(f"{element}?.getClientRects().length")
    browser.value(f"{element}.scrollIntoView({{block: 'center'}})")
    browser.frame()
    box = f"{element}.getBoundingClientRect()"
    return browser.value(f"(({{left, top, width, height}}) => [left + width / 2, top + height / 2])({box})")


def press(browser: Browser, selector: str, times: int = 1) -> None:
    """Clicks as people click: the button of the mouse is down for a while."""
    x, y = middle(browser, selector)
    for click in range(times):
        for kind in ("mousePressed", "mouseReleased"):
            about = {"x": x, "y": y, "button": "left", "buttons": 1, "clickCount": click + 1}
            browser.send("Input.dispatchMouseEvent", type=kind, **about)
            time.sleep(DOWN_S)


def test_a_part_of_a_live_page_opens_and_keeps_the_focus(browser: Browser, rows) -> None:
    with live(browser, rows, lambda i: Event(12.0 + 0.05 * i, "series joints", {"pan": 0.1 * i})):
        press(browser, "summary")
        browser.wait("document.querySelector('details').open")
        version = browser.value("document.documentElement.dataset.rows")
        browser.wait(f"document.documentElement.dataset.rows > {version} + 5")
        assert browser.value("document.activeElement.tagName") == "SUMMARY"


def test_alternatives_are_chosen_while_a_search_goes_on(browser: Browser) -> None:
    run = ROOT / "tests" / "data" / "golden" / "soccer-approach-dribble.mcap"
    events = list(recorded_events(run, RunTimeline(Explainer())))
    until_s = next(event.at_s for event in events if event.kind == "why")
    report = next(event.fields for event in events if event.kind == "refinement")
    known = [event for event in events if event.at_s <= until_s]
    with live(
        browser,
        known,
        lambda i: Event(until_s + 0.1 * i, "refinement", {**report, "evaluations": i, "finished": False}),
    ):
        second = ".chips button:nth-child(2)"
        assert browser.value(f"document.querySelector({second!r})?.ariaPressed ?? 'false'") == "false"
        press(browser, second)
        browser.wait(f"document.querySelector({second!r}).ariaPressed === 'true'")
        assert browser.value(f"document.activeElement === document.querySelector({second!r})")
        browser.wait("/: [0-9]{2,} evaluations/.test(document.querySelector('#choice small').textContent)")


def test_a_double_click_on_the_timeline_of_a_live_page_shows_all_of_it_again(browser: Browser, rows) -> None:
    first = "parseFloat(document.querySelector('#timeline svg > g:first-of-type text').textContent)"
    with live(browser, rows, lambda i: Event(12.0 + 0.05 * i, "series joints", {"pan": 0.1 * i})):
        browser.wait(f"Number(document.documentElement.dataset.at) > 12 && {first} === 0")
        x, y = middle(browser, ".hit")
        for _ in range(4):
            browser.send("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=-100, modifiers=8)
        browser.wait(f"{first} > 1")
        press(browser, ".hit", times=2)
        browser.wait(f"{first} === 0")


LABELS = "[...document.querySelectorAll('#timeline svg > g:first-of-type text')].map((e) => parseFloat(e.textContent))"


def test_keys_narrow_and_widen_the_timeline_about_the_shown_moment(browser: Browser, tmp_path, rows) -> None:
    show(browser, tmp_path / "run.html", page("arm", rows))
    whole = browser.value(LABELS)
    browser.press("z")
    narrow = browser.value(LABELS)
    assert whole[0] <= narrow[0] <= 1.0 <= narrow[-1] < whole[-1]
    browser.press("Z", shift=True)
    assert browser.value(LABELS) == whole
    browser.press("z")
    browser.press("0")
    assert browser.value(LABELS) == whole
    assert browser.errors == []


def test_a_narrowed_timeline_moves_along_with_the_shown_moment(browser: Browser, tmp_path, rows) -> None:
    show(browser, tmp_path / "run.html", page("arm", rows))
    browser.press("z")
    narrow = browser.value(LABELS)
    browser.press("End")
    moved = browser.value(LABELS)
    assert moved[0] > narrow[0]
    assert moved[-1] > narrow[-1]


def test_a_timeline_narrowed_to_another_time_stays_there_while_the_moment_moves(
    browser: Browser, tmp_path, rows
) -> None:
    """As on a live page that follows the newest moment while people look at an earlier one."""
    show(browser, tmp_path / "run.html", page("arm", rows))
    browser.press("End")
    wheel = "new WheelEvent('wheel', {deltaY: -100, shiftKey: true, clientX: 200, bubbles: true, cancelable: true})"
    for _ in range(8):
        browser.value(f"document.querySelector('#timeline svg').dispatchEvent({wheel})")
        browser.frame()
    narrow = browser.value(LABELS)
    assert narrow[-1] < browser.value("Number(document.documentElement.dataset.at)")
    browser.press("ArrowLeft")
    assert browser.value(LABELS) == narrow


def test_two_fingers_stretch_the_timeline_and_move_no_time(browser: Browser, tmp_path, rows) -> None:
    show(browser, tmp_path / "run.html", page("arm", rows))
    box = "document.querySelector('#timeline svg .hit').getBoundingClientRect()"
    left, top, width = (browser.value(f"{box}.{each}") for each in ("left", "top", "width"))
    at, whole = "document.documentElement.dataset.at", browser.value(LABELS)

    def touch(kind: str, *parts: float) -> None:
        points = [{"x": left + part * width, "y": top + 10, "id": n} for n, part in enumerate(parts)]
        browser.send("Input.dispatchTouchEvent", type=kind, touchPoints=points)
        browser.frame()

    touch("touchStart", 0.45, 0.55)
    before = browser.value(at)
    for apart in (0.1, 0.2, 0.3):
        touch("touchMove", 0.5 - apart, 0.5 + apart)
    touch("touchEnd")
    assert browser.value(at) == before
    assert browser.value(f"{LABELS}.at(-1) - {LABELS}[0]") < 0.5 * (whole[-1] - whole[0])
    browser.press("0")
    assert browser.value(LABELS) == whole
    assert browser.errors == []
