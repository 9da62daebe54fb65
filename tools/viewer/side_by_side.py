"""A page of several recorded runs beside one another, in step: one player moves all."""

from __future__ import annotations

import html
from collections.abc import Iterable, Iterator, Mapping

from tailor.tools.viewer.columns import compact_json
from tailor.tools.viewer.page import assembled, page_parts
from tailor.tools.viewer.timeline import Event

SCRIPTS = ("elements.js", "player.js", "sidebyside.js")


def side_by_side(title: str, caption: str, runs: Mapping[str, Iterable[Event]]) -> str:
    """The whole page, one file without external references; see `side_by_side_parts`."""
    return "".join(side_by_side_parts(title, caption, runs))


def side_by_side_parts(title: str, caption: str, runs: Mapping[str, Iterable[Event]]) -> Iterator[str]:
    """The same, part after part while events come, of one run after another.

    Args:
      title: Shown at the top.
      caption: Shown beside the title.
      runs: Events of each run by its title; time counts from the start of each run's first action.
    """
    texts = {"TITLE": html.escape(title), "CAPTION": html.escape(caption)}
    return assembled("sidebyside.html", SCRIPTS, texts, _data(runs))


def _data(runs: Mapping[str, Iterable[Event]]) -> Iterator[str]:
    """All runs as JSON, each with its title and its page."""
    yield '{"pages":['
    for number, (name, events) in enumerate(runs.items()):
        yield f'{"," if number else ""}{{"title":{compact_json(name)},"page":"'
        yield from (compact_json(part)[1:-1] for part in page_parts(name, events, framed=True))
        yield '"}'
    yield "]}"
