"""The live page of a whole running system, in a real browser; then the same run from its recording, and why."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path

import pytest

from runtime.processes import Child, tailor
from schemas.messages import TickReport
from tests.browser import PROGRAM, Browser
from tests.e2e.bus_system import ROOT, free_endpoint
from tools.viewer.recorded import timed

pytestmark = [
    pytest.mark.skipif(PROGRAM is None, reason="no chromium here: install Debian's package chromium"),
    pytest.mark.xdist_group("live"),
    pytest.mark.slow,
]
ROWS = "Number(document.documentElement.dataset.rows)"
LANE = "document.querySelectorAll('#timeline .bar.actual').length"


@pytest.fixture(scope="module")
def watched(tmp_path_factory):
    """A run that was recorded and watched at the same time: (recording, what the live page showed at the end)."""
    folder = tmp_path_factory.mktemp("watched")
    recording, endpoint = folder / "run.mcap", free_endpoint()
    flags = ("--once", "--seed", "11", "--record", str(recording), "--connect", endpoint)
    up = Child("up", tailor("up", "soccer", *flags), subprocess.DEVNULL)
    view = None
    try:
        time.sleep(2.0)
        with (folder / "view.log").open("w") as log:
            view = Child("view", tailor("view", "--live", "--port", "0", "--connect", endpoint), log)
        address = first_word(folder / "view.log")
        with Browser() as browser:
            browser.open(address)
            browser.wait("document.documentElement.dataset.connection === 'open'")
            browser.wait(f"{ROWS} > 100", 30)
            assert up.wait(90) == 0
            browser.wait(f"{LANE} >= 2", 5)
            browser.screenshot(folder / "live.png")
            shown = browser.value("document.querySelector('#timeline small').textContent")
            assert browser.errors == []
        yield recording, shown
    finally:
        assert view is None or view.stop() == 0
        up.stop()


def first_word(log: Path) -> str:
    deadline = time.monotonic() + 20
    while not log.read_text().startswith("http"):
        assert time.monotonic() < deadline, log.read_text()
        time.sleep(0.05)
    return log.read_text().split()[0]


def test_the_live_page_shows_every_tick_that_was_recorded_since_it_listened(watched) -> None:
    recording, shown = watched
    recorded = sum(isinstance(t.message, TickReport) for t in timed(recording))
    seen = int(shown.split()[0])
    assert recorded - 40 <= seen <= recorded, "it came two to four seconds late and then lost nothing"


def test_why_explains_the_run_that_was_watched(watched, tmp_path) -> None:
    picture = tmp_path / "why.png"
    words = [sys.executable, "-m", "tools.main", "why", str(watched[0]), "--json", "-o", str(picture)]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60, cwd=ROOT)
    assert done.returncode == 0, done.stderr
    first = json.loads(done.stdout.splitlines()[0])[0]
    assert first["actions"][-1] == "dribbleBall"
    assert first["explanation"]["cost"][0] is not None
    assert {p["quantity"] for p in first["explanation"]["parameters"]} >= {"phi", "v"}
    assert picture.stat().st_size > 10_000
