"""A page of several recorded runs beside one another, in step: one player moves all."""

from __future__ import annotations

import html
from collections.abc import Iterable, Mapping

from tailor.tools.viewer.columns import compact_json
from tailor.tools.viewer.page import assembled, page
from tailor.tools.viewer.timeline import Event

SCRIPTS = ("elements.js", "player.js", "sidebyside.js")


def side_by_side(title: str, caption: str, runs: Mapping[str, Iterable[Event]]) -> str:
    """The whole page, one file without external references.

    Args:
      title: Shown at the top.
      caption: Shown beside the title.
      runs: Events of each run by its title; time counts from the start of each run's first action.
    """
    pages = [{"title": name, "page": page(name, events, framed=True)} for name, events in runs.items()]
    texts = {"TITLE": html.escape(title), "CAPTION": html.escape(caption)}
    return assembled("sidebyside.html", SCRIPTS, texts, compact_json({"pages": pages}))
