"""A model's card in lines for people: figures first, then what the model takes and yields, where it is from last."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tailor.models.cards.card import Card

TITLE = ("robot", "action", "kind")
FIGURES = ("test", "episodes", "learner")
LAST = ("golden", "command", "versions", "sha256", "format", "provenance")
COUNTS = ("count", "finished", "on_policy", "calibrates")  # of the episodes; all else is their provenance
MAX_LEVELS = 10  # what is nested deeper is left out


def card_lines(card: Card) -> Iterator[tuple[str, str]]:
    """Name and text of each entry, without those of the title."""
    entries = {key: value for key, value in card.items() if key not in TITLE}
    episodes = entries.pop("episodes", {})
    entries["episodes"] = {key: value for key, value in episodes.items() if key in COUNTS}
    entries["provenance"] = {key: value for key, value in episodes.items() if key not in COUNTS}
    between = [key for key in entries if key not in (*FIGURES, *LAST)]
    for key in (*FIGURES, *between, *LAST):
        if entries.get(key, {}) != {}:
            yield key, _text(key, entries[key])


def _text(key: str, value: Any) -> str:
    if key == "golden":
        return f"{len(value['arguments'])} inputs and outputs"
    if key == "arguments":
        return ", ".join(f"{each['name']} {each['lower']:g}..{each['upper']:g} {each['unit']}" for each in value)
    return _brief(value)[1:-1] if isinstance(value, dict) else _brief(value)


def _brief(value: Any, levels: int = MAX_LEVELS) -> str:
    """A value in words; groups of named values in parentheses."""
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, dict | list) and not levels:
        return "..."
    if isinstance(value, dict):
        return "(" + ", ".join(f"{key} {_brief(item, levels - 1)}" for key, item in value.items()) + ")"
    if isinstance(value, list):
        return "[" + ", ".join(_brief(item, levels - 1) for item in value) + "]"
    return str(value)
