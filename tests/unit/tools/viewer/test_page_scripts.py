"""Scripts of the page without a browser, in Node.js: what a live run of more than ten minutes keeps stays true."""

from __future__ import annotations

import json
import shutil
import subprocess
from importlib import resources
from typing import Any

import pytest

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
needs_node = pytest.mark.skipif(NODE is None, reason="no Node.js here: install Debian's package nodejs")


def printed(script: str) -> Any:
    """What a script that uses the page's `Run` prints as JSON."""
    assets = resources.files("tailor.tools.viewer") / "assets"
    scripts = [(assets / name).read_text("utf-8") for name in ("elements.js", "columns.js", "run.js")]
    whole = "\n".join([*scripts, script])
    return json.loads(subprocess.run([NODE, "-"], input=whole, capture_output=True, text=True, check=True).stdout)


@needs_node
def test_a_live_page_of_weeks_keeps_what_holds_and_does_not_grow() -> None:
    found = printed(WEEKS)
    assert (found["plan"], found["subgoals"]) == ("solved", 49_999)
    assert 2001 <= found["kept"] <= 2001 + 60


@needs_node
def test_actions_whose_samples_a_live_page_has_forgotten_stand_where_they_were() -> None:
    found = printed(LIVE % (ALL_S, EACH_S))
    assert found["beliefs"] < 0.5 * 10 * ALL_S, "most samples are forgotten"
    *ended, running = found["actions"]
    assert running == pytest.approx([ALL_S - EACH_S, ALL_S, 18], abs=0.2)
    assert ended == [pytest.approx([EACH_S * k, EACH_S * (k + 1), 19], abs=0.2) for k in range(ALL_S // EACH_S - 1)]
