"""Assembles the page: template, styles, scripts and the events of a run in one file without external references."""

from __future__ import annotations

import html
import re
from collections.abc import Iterable, Iterator, Mapping
from importlib import resources

from tailor.tools.viewer.columns import Packing, compact_json
from tailor.tools.viewer.timeline import Event

STYLES = ("page.css", "controls.css", "drawing.css", "sidebyside.css")
# In the order of their dependencies; together they form one module.
SCRIPTS = (
    "elements.js",
    "scales.js",
    "columns.js",
    "run.js",
    "liveness.js",
    "places.js",
    "subgoals.js",
    "field.js",
    "series.js",
    "fieldandseries.js",
    "lanes.js",
    "stretch.js",
    "timeline.js",
    "graph.js",
    "plan.js",
    "polar.js",
    "choice.js",
    "heading.js",
    "stop.js",
    "player.js",
    "framed.js",
    "main.js",
)


def page(title: str, events: Iterable[Event], live: bool = False, stop_token: str = "", framed: bool = False) -> str:
    """The whole page; see `page_parts`."""
    return "".join(page_parts(title, events, live, stop_token, framed))


def page_parts(
    title: str, events: Iterable[Event], live: bool = False, stop_token: str = "", framed: bool = False
) -> Iterator[str]:
    """The whole page, part after part while events come: only samples are kept until all have come.

    Args:
      title: Shown at the top, e.g. the recording's name.
      events: Events of the run; a live page receives its events from the server.
      live: Whether the page connects to the server.
      stop_token: Of the server's stop button; empty: the page has no button.
      framed: Whether the page is a frame of another one, which has the player.
    """
    head = compact_json({"title": title, "live": live, "stop": stop_token, "framed": framed})
    return assembled("page.html", SCRIPTS, {"TITLE": html.escape(title)}, _data(head, events))


def _data(head: str, events: Iterable[Event]) -> Iterator[str]:
    """The object `head` with all events in it."""
    packing = Packing()
    yield f'{head[:-1]},"rows":['
    yield from _separated(packing.rows(events))
    yield '],"samples":['
    yield from _separated(packing.blocks())
    yield "]}"


def _separated(parts: Iterable[str]) -> Iterator[str]:
    return (f",{part}" if number else part for number, part in enumerate(parts))


def assembled(template: str, scripts: Iterable[str], texts: Mapping[str, str], data: Iterable[str]) -> Iterator[str]:
    """A template with everything that it needs in it, part after part.

    Args:
      template: Name of the asset with places @NAME@.
      scripts: Names of scripts; together they form one module.
      texts: Text, as HTML, for other places by name.
      data: Parts of what the scripts read, as JSON.
    """
    parts: dict[str, Iterable[str]] = {
        **{name: (text,) for name, text in texts.items()},
        "STYLE": ("\n".join(map(_asset, STYLES)),),
        "SCRIPT": ("\n".join(map(_asset, scripts)),),
        # no string of a recording may end the script element
        "DATA": (part.replace("<", "\\u003c") for part in data),
    }
    [first, *others] = re.split(r"@([A-Z]+)@", _asset(template))
    yield first
    for name, after in zip(others[::2], others[1::2], strict=True):
        yield from parts[name]
        yield after


def _asset(name: str) -> str:
    return (resources.files("tailor.tools.viewer") / "assets" / name).read_text(encoding="utf-8")
