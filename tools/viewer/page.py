"""Puts the page together: template, style and scripts in one file that fetches nothing, with the run inside it."""

from __future__ import annotations

import html
import json
from collections.abc import Iterable
from importlib import resources

from tailor.tools.viewer.timeline import Event

STYLES = ("page.css", "controls.css", "drawing.css")
# In the order in which they build on each other; together they are one module.
SCRIPTS = (
    "elements.js",
    "scales.js",
    "run.js",
    "places.js",
    "subgoals.js",
    "field.js",
    "jointplane.js",
    "series.js",
    "lanes.js",
    "timeline.js",
    "graph.js",
    "plan.js",
    "polar.js",
    "choice.js",
    "heading.js",
    "player.js",
    "main.js",
)


def page(title: str, rows: Iterable[Event], live: bool = False) -> str:
    """The whole page.

    Args:
      title: Shown at the top, e.g. the recording's name.
      rows: The run; a live page gets its rows from the server that it came from.
      live: Whether to listen for rows.
    """
    embedded = json.dumps({"title": title, "live": live, "rows": [row.json_value() for row in rows]}, allow_nan=False)
    parts = {
        "TITLE": html.escape(title),
        "STYLE": "\n".join(_asset(name) for name in STYLES),
        "SCRIPT": "\n".join(_asset(name) for name in SCRIPTS),
        # "<" must not end the script element, whatever a recording's strings say.
        "DATA": embedded.replace("<", "\\u003c"),
    }
    text = _asset("page.html")
    for name, part in parts.items():
        before, _, after = text.partition(f"@{name}@")
        text = before + part + after
    return text


def _asset(name: str) -> str:
    return (resources.files("tailor.tools.viewer") / "assets" / name).read_text(encoding="utf-8")
