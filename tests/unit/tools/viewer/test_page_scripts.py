"""Scripts of the page without a browser, in Node.js: what a live run of more than ten minutes keeps stays true."""

from __future__ import annotations

import json
import shutil
import subprocess
from importlib import resources
from typing import Any

import pytest

from tests.support.patience import PATIENCE_S

NODE = shutil.which("node")
EACH_S, ALL_S = 20, 1500
LIVE = """
const run = new Run();
let began = 0, index = -1;
for (let tick = 0; tick < 10 * %d; tick++) {
  const at = tick / 10;
  if (at >= %d * (index + 1)) {
    if (index >= 0) run.add([at, "finished", {index, actual: at - began, predicted: 19}]);
    [began, index] = [at, index + 1];
    run.add([at, "action", {index, action: "go"}]);
  }
  run.add([at, "belief", {elapsed: at - began, predicted: 18}]);
  run.forget();
}
const actions = run.actions().map(({begin, until, predicted}) => [begin, until, predicted]);
console.log(JSON.stringify({actions, beliefs: run.all("belief").length}));
"""
WEEKS = """
const run = new Run();
run.add([0, "plan", {status: "solved"}]);
for (let at = 1; at < 50000; at++) {
  run.add([at, "subgoals", {number: at}]);
  run.forget();
}
console.log(JSON.stringify({plan: run.last("plan").status, subgoals: run.last("subgoals").number, kept: run.kept()}));
"""
FLOOD = """
const run = new Run();
run.add([0, "plan", {status: "solved"}]);
for (let i = 0; i < 100000; i++) {
  run.add([i / 200, "estop", {number: i}]);
  run.forget();
}
console.log(JSON.stringify({plan: run.last("plan").status, newest: run.last("estop").number, kept: run.kept()}));
"""
RESTART = """
const made = [];
const element = () => ({ setAttribute(name, value) { this[name] = value; }, append() {}, replaceChildren() {} });
globalThis.document = { createElement: element, createElementNS: () => (made.push(element()), made.at(-1)) };
const run = new Run();
run.add([0, "outline truth ball", {robots: false, closed: true, onRobot: false, points: [[0, 0]], colour: "red"}]);
run.add([0.5, "action", {index: 0, action: "go"}]);
run.add([2, "action", {index: -1, action: ""}]);
run.add([3, "restart", {}]);
run.add([5, "action", {index: 1, action: "go"}]);
const truth = [0, 1, 2, 30, 30, 31, 32], believed = [-7, 1, 2, 2, 30, 31, 32];
truth.forEach((x, at) => {
  const index = at < 2 ? 0 : at < 5 ? -1 : 1;
  run.add([at, "truth", {x, y: 0, phi: null, index, places: {ball: [x + 1, 0, 0]}}]);
  run.add([at, "believed", {x: believed[at], y: 0, phi: null, index}]);
});
const field = new Field(run, null);
Object.assign(field, { still: element(), map: (x, y) => [x, y], headed: false });
field.layEpisode(...run.episode(0));
const paths = made.map((each) => each.d).filter((d) => d && !d.endsWith("Z"));
console.log(JSON.stringify(paths.map((path) => path.split("M").slice(1))));
"""
CARRIED = """
const run = new Run();
[0, 0.9, 1.8, 8, 8.9, 8.9].forEach((x, i) => run.add([0.3 * i, "believed", {x, y: 0, phi: 0}]));
run.add([60, "believed", {x: 12, y: 0, phi: 0}]);
console.log(JSON.stringify(run.pieces("believed", 0, Infinity).map((piece) => piece.map((p) => p.x))));
"""
COARSE = """
const found = [[1e17, 1e17 + 64], [1.7e18, 1.7e18 + 256], [-1e300, 1e300], [NaN, 1], [0, Infinity]].map(
  ([from, to]) => ticks(from, to, 5).length,
);
console.log(JSON.stringify(found));
"""
needs_node = pytest.mark.skipif(NODE is None, reason="no Node.js here: install Debian's package nodejs")


def printed(script: str) -> Any:
    """What a script that uses the page's `Run` prints as JSON."""
    assets = resources.files("tailor.tools.viewer") / "assets"
    names = ("elements.js", "scales.js", "columns.js", "run.js", "field.js")
    whole = "\n".join([*[(assets / name).read_text("utf-8") for name in names], script])
    run = subprocess.run([NODE, "-"], input=whole, capture_output=True, text=True, check=True, timeout=PATIENCE_S)
    return json.loads(run.stdout)


@needs_node
def test_a_live_page_of_weeks_keeps_what_holds_and_does_not_grow() -> None:
    found = printed(WEEKS)
    assert (found["plan"], found["subgoals"]) == ("solved", 49_999)
    assert 2001 <= found["kept"] <= 2001 + 60


@needs_node
def test_a_live_page_keeps_the_newest_events_of_a_flood() -> None:
    found = printed(FLOOD)
    assert (found["plan"], found["newest"]) == ("solved", 99_999)
    assert found["kept"] <= 1 + 20_000 + 60 * 200, "it forgets once a minute"


@needs_node
def test_actions_whose_samples_a_live_page_has_forgotten_stand_where_they_were() -> None:
    found = printed(LIVE % (ALL_S, EACH_S))
    assert found["beliefs"] < 0.5 * 10 * ALL_S, "most samples are forgotten"
    *ended, running = found["actions"]
    assert running == pytest.approx([ALL_S - EACH_S, ALL_S, 18], abs=0.2)
    assert ended == [pytest.approx([EACH_S * k, EACH_S * (k + 1), 19], abs=0.2) for k in range(ALL_S // EACH_S - 1)]


@needs_node
def test_no_line_leads_to_where_a_simulator_has_put_the_robot_at_a_restart() -> None:
    """What is believed follows later: its line begins with the first action, and goes on with the next one."""
    drawn = [[[float(x) for x, _ in map(str.split, piece.split("L"))] for piece in path] for path in printed(RESTART)]
    way, believed, ball = drawn[:-2], *drawn[-2:]
    assert way == [[[0, 1]], [[2]], [[30, 30]], [[31, 32]]]
    assert believed == [[1, 2], [31, 32]]
    assert ball == [[1, 2, 3], [31, 31, 32, 33]]


@needs_node
def test_no_line_leads_to_where_no_robot_can_have_driven_meanwhile() -> None:
    """Such as after `sim/reset`, or where a robot was carried."""
    assert printed(CARRIED) == [[0, 0.9, 1.8], [8, 8.9, 8.9, 12]]


@needs_node
def test_an_axis_has_an_end_where_floats_are_too_coarse_to_count_along_it() -> None:
    assert all(number <= 20 for number in printed(COARSE))
