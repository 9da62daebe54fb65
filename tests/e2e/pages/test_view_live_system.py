"""The live page of a whole running system, in a real browser; then the same run from its recording, and why."""

from __future__ import annotations

import json
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

from tailor.runtime.processes.child import Child, tailor
from tailor.schemas.messages import TickReport
from tailor.tools.viewer.timed_messages import timed
from tests.support.browser import PROGRAM, Browser
from tests.support.bus_system import ROOT, answers, free_endpoint
from tests.support.patience import PATIENCE_S, wait_until

pytestmark = [
    pytest.mark.skipif(PROGRAM is None, reason="no chromium here: install Debian's package chromium"),
    pytest.mark.xdist_group("live"),
    pytest.mark.slow,
]
ROWS = "Number(document.documentElement.dataset.rows)"
LANE = "document.querySelectorAll('#timeline .bar.actual').length"


@pytest.fixture(scope="module")
def watched(tmp_path_factory):
    """A run that was recorded and watched at the same time: recording, the page's words, ticks."""
    folder = tmp_path_factory.mktemp("watched")
    recording, endpoint = folder / "run.mcap", free_endpoint()
    flags = ("--once", "--seed", "11", "--record", str(recording), "--connect", endpoint)
    up = Child("up", tailor("up", "soccer", *flags), subprocess.DEVNULL)
    view = None
    try:
        wait_until(lambda: answers(endpoint), "router")
        with (folder / "view.log").open("w") as log:
            view = Child("view", tailor("view", "--live", "--port", "0", "--connect", endpoint), log)
        address = first_word(folder / "view.log")
        with Browser() as browser:
            browser.open(address)
            browser.wait("document.documentElement.dataset.connection === 'open'")
            browser.wait(f"{ROWS} > 100")
            assert up.wait(2 * PATIENCE_S) == 0
            browser.wait(f"{LANE} >= 2")
            browser.screenshot(folder / "live.png")
            shown = browser.value("document.querySelector('#timeline small').textContent")
            assert browser.errors == []
        yield recording, shown, ticks_at(address)
    finally:
        assert view is None or view.stop() == 0
        up.stop()


def first_word(log: Path) -> str:
    wait_until(lambda: log.read_text().startswith("http"), "address")
    return log.read_text().split()[0]


def ticks_at(address: str) -> list[int]:
    """The numbers of the ticks that the server keeps."""
    with urllib.request.urlopen(f"{address}events", timeout=PATIENCE_S) as stream:
        rows = next(json.loads(line[6:]) for line in stream if line.startswith(b"data: ["))
    return [fields["tick"] for _, kind, fields in rows if kind == "tick"]


def test_from_when_it_listens_the_live_page_shows_every_tick(watched) -> None:
    recording, shown, ticks = watched
    last = max(t.message.tick for t in timed(recording) if isinstance(t.message, TickReport))
    assert ticks == list(range(ticks[0], last + 1))
    assert shown.startswith(f"{len(ticks)} ticks ")


def test_why_explains_the_run_that_was_watched(watched, tmp_path) -> None:
    picture = tmp_path / "why.png"
    words = [sys.executable, "-P", "-m", "tailor.tools.main", "why", str(watched[0]), "--json", "-o", str(picture)]
    done = subprocess.run(words, capture_output=True, text=True, timeout=PATIENCE_S, cwd=ROOT)
    assert done.returncode == 0, done.stderr
    first = json.loads(done.stdout.splitlines()[0])[0]
    assert first["actions"][-1] == "dribbleBall"
    assert first["explanation"]["cost"][0] is not None
    assert {p["quantity"] for p in first["explanation"]["parameters"]} >= {"phi", "v"}
    assert picture.stat().st_size > 10_000
