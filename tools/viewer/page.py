"""Assembles the page: template, styles, scripts and the events of a run in one file without external references."""

from __future__ import annotations

import html
import json
from collections.abc import Iterable
from importlib import resources

from tailor.tools.viewer.timeline import Event

STYLES = ("page.css", "controls.css", "drawing.css")
# In the order of their dependencies; together they form one module.
SCRIPTS = (
    "elements.js",
    "scales.js",
    "run.js",
    "places.js",
    "subgoals.js",
    "field.js",
    "series.js",
    "fieldandseries.js",
    "lanes.js",
    "timeline.js",
    "graph.js",
    "plan.js",
    "polar.js",
    "choice.js",
    "heading.js",
    "stop.js",
    "player.js",
    "main.js",
)


def page(title: str, events: Iterable[Event], live: bool = False, stop_token: str = "") -> str:
    """The whole page.

    Args:
      title: Shown at the top, e.g. the recording's name.
      events: Events of the run; a live page receives its events from the server.
      live: Whether the page connects to the server.
      stop_token: Of the server's stop button; empty: the page has no button.
    """
    embedded = json.dumps(
        {"title": title, "live": live, "stop": stop_token, "rows": [event.json_value() for event in events]},
        allow_nan=False,
    )
    parts = {
        "TITLE": html.escape(title),
        "STYLE": "\n".join(_asset(name) for name in STYLES),
        "SCRIPT": "\n".join(_asset(name) for name in SCRIPTS),
        # no string of a recording may end the script element
        "DATA": embedded.replace("<", "\\u003c"),
    }
    text = _asset("page.html")
    for name, part in parts.items():
        before, _, after = text.partition(f"@{name}@")
        text = before + part + after
    return text


def _asset(name: str) -> str:
    return (resources.files("tailor.tools.viewer") / "assets" / name).read_text(encoding="utf-8")
