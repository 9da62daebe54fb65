"""The pages in a real headless browser: what is drawn, how it moves, and how a live page follows."""

from __future__ import annotations

import re
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from tailor.schemas import messages as m
from tailor.tools.viewer import timeline as timeline_module
from tailor.tools.viewer.explainer import Explainer
from tailor.tools.viewer.live.broadcast import EventBroadcast
from tailor.tools.viewer.live.server import MAX_PAGES, serving
from tailor.tools.viewer.live.stop_endpoint import StopEndpoint
from tailor.tools.viewer.page import page
from tailor.tools.viewer.recorded_events import recorded_events
from tailor.tools.viewer.timeline import Event, RunTimeline
from tests.support import synthetic_run
from tests.support.browser import PROGRAM, Browser
from tests.support.bus_system import ROOT
from tests.support.synthetic_models import LIBRARY, MODELS

pytestmark = [
    pytest.mark.skipif(PROGRAM is None, reason="no chromium here: install Debian's package chromium"),
    pytest.mark.xdist_group("browser"),
]
AT = "Number(document.documentElement.dataset.at)"
NOT_DONE = ["failed", "aborted"]
NAMES = ["x (m)", "y (m)", "phi (rad)", "v (m/s)", "omega (rad/s)", "ball_x (m)", "ball_y (m)"]


# How many lines across the heading the paths of a kind have.
LINES = """[...document.querySelectorAll('#scene .strokes{}')]
  .map((path) => path.getAttribute('d').split('M').length - 1).reduce((a, b) => a + b, 0)"""
BOX = """(({left, top, width, height}) => [left, top, width, height])(
  document.querySelector('#timeline svg .hit').getBoundingClientRect())"""
# The least contrast of words on a panel, by the formula of WCAG 2.
WORST_CONTRAST = """(() => {
  const linear = (v) => (v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
  const light = (colour) => {
    const [r, g, b] = colour.match(/[0-9.]+/g).map((v) => linear(v / 255));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const panel = light(getComputedStyle(document.querySelector('.panel')).backgroundColor);
  const words = [...document.querySelectorAll('h1, th, td, .panel h2 small, figcaption')];
  return Math.min(...words.map((element) => {
    const [dark, bright] = [light(getComputedStyle(element).color), panel].sort((a, b) => a - b);
    return (bright + 0.05) / (dark + 0.05);
  }));
})()"""


class Context:
    """As much of an executive's context as an explanation needs."""

    class domain:  # noqa: N801
        name = "synthetic"
        actions = LIBRARY

    class settings:  # noqa: N801
        seed = 3
        refinement = synthetic_run.SETTINGS

    models = MODELS


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with Browser() as opened:
        yield opened


@pytest.fixture(scope="module")
def soccer(tmp_path_factory) -> str:
    """Address of the page of a soccer run."""
    facts = {
        "times": {"period": 100, "budget": 60, "end": 80},
        "robot": "agilo",
        "beliefNames": NAMES,
        "domain": "soccer",
    }
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(timeline_module, "run_facts", lambda provenance: facts)
        rows = rows_of(synthetic_run.soccer_run(), RunTimeline(Explainer(lambda recorded: Context)))
    return written(tmp_path_factory.mktemp("view") / "soccer.html", rows)


def rows_of(run, timeline: RunTimeline) -> list[Event]:
    return [row for t in run for row in timeline.events_of(t.time_ns / 1e9, t.key, t.message)]


def written(path: Path, rows: list[Event]) -> str:
    path.write_text(page(path.stem, rows))
    return path.as_uri()


def count(browser: Browser, selector: str) -> int:
    return browser.value(f"document.querySelectorAll({selector!r}).length")


def text(browser: Browser, selector: str) -> str:
    return browser.value(f"document.querySelector({selector!r}).textContent")


def at(browser: Browser) -> float:
    return browser.value(AT)


def opened(browser: Browser, address: str, at_s: float | None = None) -> None:
    browser.errors.clear()
    browser.send("Page.navigate", url="about:blank")
    browser.open(address + (f"#t={at_s}" if at_s is not None else ""))
    browser.frame()


def test_the_path_is_drawn_with_lines_across_the_heading_up_to_the_moment(browser: Browser, soccer: str) -> None:
    opened(browser, soccer, 4.0)
    whole = browser.value(LINES.format(".ahead"))
    until_now = browser.value(LINES.format(":not(.ahead)"))
    assert whole == pytest.approx(110, abs=5), "one line for each of the executive's ticks"
    assert until_now == pytest.approx(38, abs=2)
    assert count(browser, "#scene .object") == 1
    assert browser.errors == []


def test_the_subgoal_shows_choice_greedy_and_alternatives(browser: Browser, soccer: str) -> None:
    opened(browser, soccer, 4.0)
    assert count(browser, "#scene .place.lone") == 1
    assert count(browser, "#scene .petal") == 73
    assert count(browser, "#choice figure") == 3, "action 1, action 2 and their sum, as in Figure 11"
    words = text(browser, "#choice .verdict")
    assert re.search(r"than greedy.*: approachBall takes [\d.]+ s longer .*, dribbleBall [\d.]+ s less", words)
    browser.value("document.querySelectorAll('#choice .chips button')[1].click()")
    browser.frame()
    assert count(browser, "#choice .plots") == 0, "a speed is no angle"
    assert count(browser, "#choice figure") == 1


def test_where_nothing_is_free_a_button_leads_to_the_last_choice(browser: Browser, soccer: str) -> None:
    button = "#choice .empty button"
    opened(browser, soccer)
    assert "No parameter was free" in text(browser, "#choice .empty")
    decided_s = float(text(browser, button).removesuffix(" s"))
    browser.value(f"document.querySelector({button!r}).click()")
    browser.frame()
    assert at(browser) == pytest.approx(decided_s, abs=0.01)
    assert (count(browser, button), count(browser, "#choice figure")) == (0, 3)


def test_no_wall_nor_robot_covers_the_numbers_of_the_scene(browser: Browser, tmp_path: Path) -> None:
    run = ROOT / "tests" / "data" / "golden" / "soccer-approach.mcap"
    opened(browser, written(tmp_path / "soccer.html", recorded_events(run, RunTimeline())))
    is_above = "(e) => shapes.every((s) => s.compareDocumentPosition(e) === Node.DOCUMENT_POSITION_FOLLOWING)"
    found = f"""(() => {{
      const shapes = [...document.querySelectorAll('#scene .backdrop, #scene .robot')];
      const numbers = [...document.querySelectorAll('#scene .numbers text')];
      return [shapes.length, numbers.length, numbers.filter({is_above}).length];
    }})()"""
    shapes, numbers, above = browser.value(found)
    assert shapes > 1
    assert above == numbers >= 4


def test_the_plan_shows_what_runs_what_is_done_and_what_links(browser: Browser, soccer: str) -> None:
    opened(browser, soccer, 4.0)
    assert text(browser, "#plan .running") == "approachball pos1 pos2"
    assert count(browser, "#plan .done") == 0
    assert "(atball pos2)" in text(browser, "#plan svg")
    opened(browser, soccer, 8.0)
    assert text(browser, "#plan .running") == "dribbleball pos2 pos3"
    assert text(browser, "#plan .done") == "approachball pos1 pos2"


def test_the_timeline_shows_predicted_against_actual_and_every_tick(browser: Browser, soccer: str) -> None:
    opened(browser, soccer)
    assert count(browser, "#timeline .bar.predicted") == 2
    assert count(browser, "#timeline .bar.actual") == 2
    assert count(browser, "#timeline .limit") == 2
    ticks = sum(isinstance(t.message, m.TickReport) for t in synthetic_run.soccer_run())
    assert text(browser, "#timeline small").startswith(f"{ticks} ticks ")


@pytest.mark.parametrize(
    "size",
    [(375, 812), (390, 844), (1100, 900), (1280, 800), (1280, 1400), (1440, 900), (1920, 1080)],
    ids="{0[0]}x{0[1]}".format,
)
def test_the_page_fits_a_phone_and_screens_with_its_timeline_above_the_fold(
    browser: Browser, soccer: str, size
) -> None:
    width, height = size
    browser.resize(width, height)
    opened(browser, soccer, 4.0)
    assert browser.value("document.documentElement.scrollWidth") == width
    rights = "[...document.querySelectorAll('footer > *')].map((e) => e.getBoundingClientRect().right)"
    assert max(browser.value(rights)) <= width, "speed and other controls can be reached"
    box = browser.value(BOX)
    footer = browser.value("document.querySelector('footer').offsetHeight")
    lanes = "[...document.querySelectorAll('#timeline [data-lane]')].map((lane) => lane.getBoundingClientRect().bottom)"
    bottoms = browser.value(lanes)
    seen = sum(bottom <= height - footer for bottom in bottoms)
    assert seen >= (3 if width < 500 else len(bottoms)), "actions, events, speed; on a screen all lanes"
    assert box[2] > 0.45 * width
    letter = (
        "Math.min(...[...document.querySelectorAll('#timeline svg text')].map((e) => e.getBoundingClientRect().height))"
    )
    assert browser.value(letter) > 9, "legible"
    cut = "(e => e.scrollWidth - e.clientWidth)(document.querySelector('#choice .body'))"
    assert browser.value(cut) <= 0, "the greedy choice and the difference are in sight"
    assert browser.errors == []
    browser.send("Emulation.clearDeviceMetricsOverride")


def test_a_heading_folds_its_panel_and_what_is_below_moves_up(browser: Browser, soccer: str) -> None:
    opened(browser, soccer, 4.0)
    before = browser.value(BOX)[1]
    browser.value("document.querySelectorAll('#scene h2, #choice h2, #plan h2').forEach((heading) => heading.click())")
    browser.frame()
    assert browser.value(BOX)[1] < before - 100
    assert text(browser, "#scene .fold") == ""
    assert browser.value("document.querySelector('#scene .fold').ariaExpanded") == "false"
    browser.value("document.querySelector('#scene h2').click()")
    browser.frame()
    assert browser.value("document.querySelector('#scene .layers').offsetHeight") > 100


def test_the_button_that_folds_a_panel_is_named_as_the_panel(browser: Browser, soccer: str) -> None:
    opened(browser, soccer, 4.0)
    nodes = browser.send("Accessibility.getFullAXTree")["nodes"]
    names = [node["name"]["value"] for node in nodes if node.get("role", {}).get("value") == "button"]
    assert {"Scene", "Subgoals", "Plan", "Timeline"} <= set(names)


def test_an_aborted_action_has_another_colour_than_a_failed_one_and_both_are_explained(
    browser: Browser, tmp_path: Path
) -> None:
    run = synthetic_run.arm_run(outcomes=("failed", "aborted", "done", "done"))
    opened(browser, written(tmp_path / "arm.html", rows_of(run, RunTimeline())), 6.0)
    colours = {kind: f"getComputedStyle(document.querySelector('#timeline .bar.{kind}')).fill" for kind in NOT_DONE}
    assert len({browser.value(colour) for colour in colours.values()}) == 2
    assert count(browser, "#timeline .bar.actual") == 4
    assert browser.value("[...document.querySelectorAll('#timeline .legend i')].map((e) => e.textContent)") == NOT_DONE


def test_a_drawing_below_a_heading_of_three_lines_keeps_its_numbers(browser: Browser, soccer: str) -> None:
    browser.resize(1440, 900)
    opened(browser, soccer, 4.0)
    browser.value("document.querySelector('#scene small').append(' an action'.repeat(14))")
    browser.frame()
    bottom = "document.querySelector('#scene{}').getBoundingClientRect().bottom"
    all_bottoms = "[...document.querySelectorAll('#scene .numbers text')].map((e) => e.getBoundingClientRect().bottom)"
    assert browser.value("document.querySelector('#scene h2').offsetHeight") > 50, "three lines"
    lowest = max(browser.value(all_bottoms))
    assert lowest < browser.value(bottom.format(" .body")) <= browser.value(bottom.format(""))
    browser.send("Emulation.clearDeviceMetricsOverride")


@pytest.mark.slow
def test_an_hours_page_opens_fast_and_draws_what_a_pixel_can_show(browser: Browser, tmp_path) -> None:
    hour = [
        Event(0.1 * i, kind, fields)
        for i in range(36_000)
        for kind, fields in (
            ("truth", {"x": i % 70 / 20, "y": 0.0, "phi": 0.01 * (i % 300), "v": i % 9 / 10, "index": i // 100 % 4}),
            ("tick", {"tick": i, "late": 3.0, "control": 1.0, "work": 5.0, "skipped": i % 2, "checks": i % 40}),
            ("belief", {"elapsed": 0.1 * (i % 100), "predicted": 10.0, "values": [0.1 * i, 0.0]}),
        )
    ]
    hour += [Event(10.0 * i, "action", {"index": i % 4, "action": "go"}) for i in range(360)]
    browser.send("Performance.enable", timeDomain="threadTicks")
    opened(browser, written(tmp_path / "hour.html", hour))
    metrics = {each["name"]: each["value"] for each in browser.send("Performance.getMetrics")["metrics"]}
    browser.send("Performance.disable")
    assert metrics["TaskDuration"] < 2.0, "seconds of the page's thread"
    assert text(browser, "#timeline small").startswith("36000 ticks ")
    drawn = browser.value("document.querySelector('[data-lane=checks] .trace').getAttribute('d').length")
    assert drawn < 4 * 1500 * 15, "at most four points a pixel"
    assert count(browser, "#timeline .late") < 2 * 1500
    assert browser.errors == []


def test_keys_move_play_and_jump(browser: Browser, soccer: str) -> None:
    opened(browser, soccer, 4.0)
    assert at(browser) == 4.0
    browser.press("ArrowRight")
    browser.press("ArrowRight", shift=True)
    assert at(browser) == pytest.approx(5.1)
    browser.press("ArrowLeft")
    assert at(browser) == pytest.approx(5.0)
    browser.press("Home")
    browser.wait(f"{AT} === 0")
    browser.press("]")
    first = at(browser)
    assert first == pytest.approx(0.2), "the plan was found then"
    browser.press(" ")
    browser.wait(f"{AT} > {first + 0.2}")
    browser.press(" ")
    paused = at(browser)
    time.sleep(0.2)
    assert at(browser) == paused
    browser.press("End")
    assert at(browser) == browser.value("Number(document.querySelector('footer input').max)")


def test_a_click_on_the_timeline_goes_there(browser: Browser, soccer: str) -> None:
    opened(browser, soccer, 0.0)
    browser.value("window.scrollTo(0, 1e6)")
    browser.frame()
    left, top, width, height = browser.value(BOX)
    browser.click(left + width / 2, top + height / 2)
    end = browser.value("Number(document.querySelector('footer input').max)")
    assert at(browser) == pytest.approx(end / 2, abs=0.1)


def test_a_robot_that_is_no_point_on_the_plane_gets_plots_over_time(browser: Browser, tmp_path: Path) -> None:
    opened(browser, written(tmp_path / "arm.html", rows_of(synthetic_run.arm_run(), RunTimeline())), 6.0)
    assert text(browser, "#scene h2 span") == "State"
    assert count(browser, "#scene .trace") == 4
    assert count(browser, "#timeline .bar.actual") == 4
    assert browser.errors == []


def test_a_live_page_on_a_phone_has_its_live_button_in_sight(browser: Browser) -> None:
    broadcast = EventBroadcast()
    with serving(page("live", [], live=True), broadcast, 0) as port:
        browser.resize(375, 667)
        broadcast.publish([Event(1234.5, "state", {"mode": "READY", "reason": "", "result": ""})])
        opened(browser, f"http://127.0.0.1:{port}/")
        browser.wait(f"{AT} > 1234")
        rights = "[...document.querySelectorAll('footer > *')].map((e) => e.getBoundingClientRect().right)"
        assert max(browser.value(rights)) <= 375
    browser.send("Emulation.clearDeviceMetricsOverride")
    browser.errors.clear()  # of the server that is gone


def test_a_damaged_recording_says_so_above_its_page(browser: Browser, tmp_path: Path) -> None:
    rows = rows_of(synthetic_run.soccer_run(), RunTimeline())
    path = written(tmp_path / "torn.html", [Event(0.0, "damage", {"text": "torn.mcap is damaged"}), *rows])
    opened(browser, path)
    assert "torn.mcap is damaged" in text(browser, "#heading")


def test_an_axis_of_the_scene_has_two_numbers_at_least(browser: Browser, tmp_path: Path) -> None:
    corners = [(-3.9, -2.9), (3.9, -2.9), (3.9, 2.9), (-3.9, 2.9)]
    rows = [
        Event(0.5 * k, "truth", {"x": x, "y": y, "phi": 0.0, "v": 0.5, "index": -1}) for k, (x, y) in enumerate(corners)
    ]
    browser.resize(1280, 800)
    opened(browser, written(tmp_path / "room.html", rows))
    numbers = "[...document.querySelectorAll('#scene svg text')].filter((e) => /^-?[0-9.]+$/.test(e.textContent))"
    lefts = browser.value(f"{numbers}.map((e) => Number(e.getAttribute('x')))")
    assert min(lefts.count(3), len(lefts) - lefts.count(3)) >= 2, "of y, whose numbers stand at the left; of x"
    browser.send("Emulation.clearDeviceMetricsOverride")


def test_an_arm_is_drawn_from_behind_above_its_values_over_time(browser: Browser, tmp_path: Path) -> None:
    rows = recorded_events(ROOT / "tests" / "data" / "golden" / "arm-word-I.mcap", RunTimeline())
    opened(browser, written(tmp_path / "letter.html", rows), 3.0)
    assert count(browser, "#scene path.robot.pale") == 13, "six modules, five links, column and tip"
    assert count(browser, "#scene .layers .trace") >= 4, "the pen's line, one for each stroke"
    assert count(browser, "#scene .plots svg") >= 4
    assert count(browser, "#timeline [data-lane='speed']") == 0, "what has no speed has no curve of zeros"
    assert browser.errors == []


def test_opponents_of_the_robots_scene_are_drawn_where_they_stand(browser: Browser, tmp_path: Path) -> None:
    rows = recorded_events(ROOT / "tests" / "data" / "golden" / "soccer-opponents.mcap", RunTimeline())
    opened(browser, written(tmp_path / "opponents.html", rows), 5.0)
    assert count(browser, "#scene .above path.object") >= 2
    assert count(browser, "#scene .above path.robot") >= 5, "chassis, wheels, rail and the mark ahead"
    assert browser.errors == []


def test_the_page_says_why_a_subgoal_was_asserted(browser: Browser, tmp_path: Path) -> None:
    rows = recorded_events(ROOT / "tests" / "data" / "golden" / "soccer-opponents.mcap", RunTimeline(Explainer()))
    opened(browser, written(tmp_path / "why.html", rows), 4.0)
    words = "By way of a subgoal: straight to its goal goToPose is predicted to fail with 9. %, this way with 1 %."
    assert re.fullmatch(words, text(browser, "#choice .verdict"))
    assert browser.errors == []


def test_an_empty_run_is_a_page_and_not_an_error(browser: Browser, tmp_path: Path) -> None:
    opened(browser, written(tmp_path / "empty.html", []))
    assert "No subgoals yet" in text(browser, "#choice .body")
    assert browser.errors == []


def test_hostile_strings_are_shown_and_never_run(browser: Browser, tmp_path: Path) -> None:
    evil = '<img src=x onerror="window.hit=1"></script><script>window.hit=1</script>'
    plan = synthetic_run.PLAN.replace("pos2", "<b>pos2</b>")
    messages = [
        synthetic_run.Published(
            0, "exec/status", m.ExecStatus(0, 1, "FAULT", evil, evil, evil, f"failed: {evil}", evil, 0, 0.0, 1.0)
        ),
        synthetic_run.Published(0, "exec/plan", m.PlanReport(0, "solved", evil, plan, 1, 1, evil)),
        synthetic_run.Published(0, "exec/finished", m.ActionFinished(0, 1, evil, 0, "failed", evil, 1.0, 1.0)),
    ]
    opened(browser, written(tmp_path / "evil.html", rows_of(messages, RunTimeline())))
    assert evil in text(browser, "#heading")
    assert browser.value("window.hit") is None
    assert count(browser, "main img, main b, main script") == 0


def test_both_colour_schemes_have_readable_ink(browser: Browser, soccer: str) -> None:
    opened(browser, soccer, 4.0)
    for dark in (False, True):
        browser.dark(dark)
        browser.frame()
        assert browser.value(WORST_CONTRAST) >= 4.5, "WCAG AA"
    browser.dark(False)


def test_a_live_page_follows_pauses_and_survives_the_server(browser: Browser) -> None:
    rows = rows_of(synthetic_run.soccer_run(), RunTimeline())
    half = len(rows) // 2
    broadcast = EventBroadcast()
    with serving(page("live", [], live=True), broadcast, 0) as port:
        broadcast.publish(rows[:half])
        opened(browser, f"http://127.0.0.1:{port}/")
        browser.wait(f"Math.abs({AT} - {rows[half - 1].at_s}) < 0.01")
        browser.press("Home")
        broadcast.publish(rows[half:])
        browser.wait(f"Number(document.documentElement.dataset.rows) >= {len(rows)}")
        assert at(browser) == 0, "whoever looks at the past is left there"
        browser.press("l")
        assert at(browser) == pytest.approx(rows[-1].at_s, abs=0.01)
    again = EventBroadcast()
    again.publish(rows[:5])
    with serving(page("live", [], live=True), again, port):
        browser.wait(f"Math.abs(Number(document.querySelector('footer input').max) - {rows[4].at_s}) < 0.01")
    assert browser.errors == []


def test_the_scene_of_a_live_page_that_began_empty_folds(browser: Browser) -> None:
    broadcast = EventBroadcast()
    with serving(page("live", [], live=True), broadcast, 0) as port:
        opened(browser, f"http://127.0.0.1:{port}/")
        assert text(browser, "#scene h2 span") == "State"
        broadcast.publish(rows_of(synthetic_run.soccer_run(), RunTimeline()))
        browser.wait("document.querySelector('#scene h2 span').textContent === 'Scene'")
        assert count(browser, "#scene .fold") == 1
        browser.value("document.querySelector('#scene h2').click()")
        assert browser.value("document.querySelector('#scene').classList.contains('folded')")
    browser.errors.clear()  # of the server that is gone


def test_without_models_each_variable_is_listed_once(browser: Browser, tmp_path: Path) -> None:
    opened(browser, written(tmp_path / "plain.html", rows_of(synthetic_run.soccer_run(), RunTimeline())), 1.0)
    names = browser.value("[...document.querySelectorAll('#choice td:first-child')].map((cell) => cell.textContent)")
    free = [name for name in names if " at " in name]
    assert free == ["approachBall: phig at pos2", "approachBall: vg at pos2"]


def test_the_stop_button_shows_what_the_drivers_confirm_also_after_a_restart_of_the_server(browser: Browser) -> None:
    def served(port: int, states: dict[str, m.DriverState]):
        endpoint = StopEndpoint(lambda: states)
        return serving(page("live", [], live=True, stop_token=endpoint.token), EventBroadcast(), port, endpoint)

    press = "document.querySelector('button.stop').click()"
    outcome = "document.querySelector('.outcome').textContent"
    with served(0, {"agilo": m.DriverState(0, "estopped", "e-stop", "", 1, "", 0)}) as port:
        opened(browser, f"http://127.0.0.1:{port}/")
        browser.value(press)
        browser.wait(f"{outcome}.endsWith(': agilo is estopped')")
        assert count(browser, ".outcome.confirmed") == 1
    browser.wait("document.documentElement.dataset.connection === 'lost'")
    with served(port, {}):
        browser.value(press)  # before the page has connected again and received the new server's token
        browser.wait(f"{outcome}.endsWith('NOT CONFIRMED: no driver is heard on the bus')")
        assert count(browser, ".outcome.failed") == 1
    assert all("403" in error for error in browser.errors), "nothing but the refusal of the old token"


def test_a_press_without_a_bus_says_so_and_not_that_there_is_no_driver(browser: Browser) -> None:
    endpoint = StopEndpoint(dict, connected=lambda: False)
    with serving(page("live", [], live=True, stop_token=endpoint.token), EventBroadcast(), 0, endpoint) as port:
        opened(browser, f"http://127.0.0.1:{port}/")
        browser.wait("document.documentElement.dataset.connection === 'open'")
        browser.value("document.querySelector('button.stop').click()")
        browser.wait("document.querySelector('.outcome.failed') !== null")
        assert "not connected to the bus" in text(browser, ".outcome")
    browser.errors.clear()  # of the server that is gone


def test_a_confirmed_stop_is_shown_until_the_driver_is_released(browser: Browser) -> None:
    broadcast = EventBroadcast()
    endpoint = StopEndpoint(lambda: {"agilo": m.DriverState(0, "estopped", "e-stop", "", 1, "", 0)})
    with serving(page("live", [], live=True, stop_token=endpoint.token), broadcast, 0, endpoint) as port:
        broadcast.publish([Event(1.0, "driver", {"mode": "estopped", "reason": "e-stop"})])
        opened(browser, f"http://127.0.0.1:{port}/")
        browser.wait("Number(document.documentElement.dataset.rows) > 0")
        browser.value("document.querySelector('button.stop').click()")
        browser.wait("document.querySelector('.outcome.confirmed') !== null")
        broadcast.publish([Event(2.0, "driver", {"mode": "armed", "reason": ""})])
        browser.wait("document.querySelector('.outcome').textContent === ''")
    browser.errors.clear()


def test_what_was_heard_last_is_not_shown_as_live(browser: Browser) -> None:
    gone = "document.querySelector('#heading .gone').textContent"
    broadcast = EventBroadcast()
    with serving(page("live", [], live=True), broadcast, 0) as port:
        broadcast.publish([Event(1.0, "state", {"mode": "EXECUTING", "reason": "", "result": ""})])
        opened(browser, f"http://127.0.0.1:{port}/")
        browser.wait(f"{AT} === 1")
        broadcast.beat(1.2, bus=True)
        assert browser.value(gone) == ""
        broadcast.publish([Event(1.6, "silent", {"executive": 1.0})])
        broadcast.beat(5.0, bus=True)
        browser.wait(f"{gone}.startsWith('NOT LIVE: executive silent for 4.0 s.')")
        assert browser.value("document.title") == "NOT LIVE: live"
        broadcast.publish([Event(6.0, "silent", {})])
        browser.wait(f"{gone} === ''")
        broadcast.beat(6.1, bus=False)
        browser.wait(f"{gone}.startsWith('NOT LIVE: the viewer has lost the bus.')")
        browser.wait(f"{gone}.startsWith('NOT LIVE: the viewer does not respond.')")  # no beat for three seconds
        broadcast.beat(6.2, bus=True)
        browser.wait(f"{gone} === ''")
    browser.wait(f"{gone}.startsWith('NOT LIVE: the viewer does not respond.')")
    browser.errors.clear()


def test_a_page_too_many_says_so_and_is_served_when_another_one_closes(browser: Browser) -> None:
    broadcast = EventBroadcast()
    gone = "document.querySelector('#heading .gone').textContent"
    with serving(page("live", [], live=True), broadcast, 0) as port, ExitStack() as others:
        for _ in range(MAX_PAGES):
            others.enter_context(broadcast.subscribe())
        opened(browser, f"http://127.0.0.1:{port}/")
        browser.wait(f"{gone}.includes('serves no more pages')")
        others.close()
        browser.wait("document.documentElement.dataset.connection === 'open'")
        browser.wait(f"{gone} === ''")
    browser.errors.clear()


def test_a_recorded_page_has_no_stop_button(browser: Browser, soccer: str) -> None:
    opened(browser, soccer)
    assert count(browser, "button.stop") == 0


def test_a_live_page_keeps_up_with_ten_batches_a_second(browser: Browser) -> None:
    rows = rows_of(synthetic_run.soccer_run(), RunTimeline())
    broadcast = EventBroadcast()
    with serving(page("live", [], live=True), broadcast, 0) as port:
        opened(browser, f"http://127.0.0.1:{port}/")

        def feeding() -> None:
            for k in range(0, 150, 5):
                broadcast.publish(rows[k : k + 5])
                time.sleep(0.1)

        thread = threading.Thread(target=feeding)
        thread.start()
        thread.join()
        browser.wait("Number(document.documentElement.dataset.rows) >= 150", 20)
        assert browser.errors == []


def test_a_page_of_hours_keeps_ten_minutes_of_samples_and_every_other_event(browser: Browser) -> None:
    """Without a limit its frames, and its stop button with them, took 4 s after three hours."""
    broadcast, hour = EventBroadcast(), range(0, 36_000)
    with serving(page("live", [], live=True), broadcast, 0) as port:
        opened(browser, f"http://127.0.0.1:{port}/")
        browser.wait("document.documentElement.dataset.connection === 'open'")
        broadcast.publish(
            [
                Event(0.0, "outline truth field", {"points": []}),
                Event(0.0, "plan", {"status": "solved", "way": "searched", "steps": []}),
            ]
        )
        for first in hour[::600]:
            broadcast.publish([Event(0.1 * k, "tick", {"tick": k, "work": 1.0}) for k in range(first, first + 600)])
            browser.frame()
        browser.wait(f"{AT} > {0.1 * hour[-1] - 0.2}")
        kept = int(browser.value("document.documentElement.dataset.kept"))
        assert 6000 <= kept <= 6000 + 600 + 10
        assert text(browser, "#plan small").startswith("solved"), "the plan of an hour ago is in force"
    browser.errors.clear()  # of the server that is gone


def test_the_wheel_with_shift_zooms_the_timeline_and_a_double_click_shows_all(browser: Browser, soccer: str) -> None:
    opened(browser, soccer, 4.0)
    labels = (
        "[...document.querySelectorAll('#timeline svg > g:first-of-type text')].map((e) => parseFloat(e.textContent))"
    )
    whole = browser.value(labels)
    wheel = "new WheelEvent('wheel', {deltaY: -100, shiftKey: %s, clientX: 600, bubbles: true, cancelable: true})"
    for shift, changes in (("false", False), ("true", True)):
        browser.value(f"document.querySelector('#timeline svg').dispatchEvent({wheel % shift})")
        browser.frame()
        assert (browser.value(labels) != whole) == changes, "plain scrolling stays the page's"
    browser.value("document.querySelector('#timeline svg').dispatchEvent(new MouseEvent('dblclick', {bubbles: true}))")
    browser.frame()
    assert browser.value(labels) == whole


def test_a_long_plan_keeps_its_running_step_in_sight(browser: Browser, tmp_path: Path) -> None:
    steps = range(1, 21)
    text_of = "".join(f"\nStep {k:<3} : (reach p{k - 1} p{k})\n          {k - 1:<3} -> (at p{k - 1})\n" for k in steps)
    pairs = " ".join(f"{k}<{k + 1}" for k in steps[:-1])
    plan = f";long\nInitial  : (at p0)\n{text_of}\nGoal     :\n          20  -> (at p20)\norderings = {{ {pairs} }}\n"
    running = m.Subgoals(0, 1, 1, (m.InstantiatedAction("reach", 18, False, 1.0, 0.1, ()),))
    status = synthetic_run.status(0, "EXECUTING", "", "reach", 17, 0.0, 1.0, ())
    messages = [
        synthetic_run.Published(0, "exec/plan", m.PlanReport(0, "solved", "searched", plan, 1, 1, "")),
        synthetic_run.Published(0, "exec/subgoals", running),
        synthetic_run.Published(0, "exec/status", status),
    ]
    opened(browser, written(tmp_path / "long.html", rows_of(messages, RunTimeline())))
    seen = """((box, node) => node.top >= box.top && node.bottom <= box.bottom)(
      document.querySelector('#plan .body').getBoundingClientRect(),
      document.querySelector('#plan .running').getBoundingClientRect())"""
    assert browser.value("document.querySelector('#plan .body').scrollTop") > 0
    assert browser.value(seen)
