"""The page is one file that fetches nothing, and nothing that a recording says can get out of its data."""

from __future__ import annotations

import json
import re
from importlib import resources

from tailor.tools.viewer import side_by_side
from tailor.tools.viewer.page import SCRIPTS, page
from tailor.tools.viewer.timeline import Event

EVIL = "</script><script>alert(1)</script>"


def test_the_page_fetches_nothing() -> None:
    text = page("run", [])
    addresses = set(re.findall(r"[a-z]+://[^\s\"')]+", text))
    assert addresses == {"http://www.w3.org/2000/svg"}, "the name of a vocabulary, not an address"
    assert not re.search(r"<(script|img|link|iframe)[^>]+(src|href)=", text)
    assert "default-src 'none'" in text


def test_every_script_is_in_the_page() -> None:
    there = {f.name for f in (resources.files("tailor.tools.viewer") / "assets").iterdir() if f.name.endswith(".js")}
    assert there == {*SCRIPTS, *side_by_side.SCRIPTS}


def test_strings_of_a_recording_cannot_end_the_data() -> None:
    text = page(EVIL, [Event(0.0, "state", {"reason": EVIL, "mode": "@SCRIPT@"})])
    assert text.count("</script>") == page("run", []).count("</script>")
    embedded = re.search(r'id="data">(.*?)</script>', text, re.DOTALL)[1]
    assert json.loads(embedded)["rows"] == [[0.0, "state", {"reason": EVIL, "mode": "@SCRIPT@"}]]


def test_a_live_page_says_that_it_is_live() -> None:
    assert '"live":true' in page("run", [], live=True)


def test_a_page_of_several_runs_fetches_nothing_either() -> None:
    text = side_by_side.side_by_side(EVIL, EVIL, {EVIL: [Event(0.0, "state", {"reason": EVIL})], "b": []})
    assert "alert(1)</script>" not in text
    assert text.count("</script>") == 2
    assert set(re.findall(r"[a-z]+://[^\s\"')\\]+", text)) == {"http://www.w3.org/2000/svg"}
