"""A model's card in lines for people: figures first, then what the model takes and yields, where it is from last."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from tailor.models.cards.card import Card
from tailor.models.cards.json_shape import are_rows

TITLE = ("robot", "action", "kind")
FIGURES = ("test", "episodes", "learner")
LAST = ("golden", "command", "versions", "sha256", "format", "provenance")
COUNTS = ("count", "finished", "on_policy", "calibrates")  # of the episodes; all else is their provenance
MAX_LEVELS = 10  # what is nested deeper is left out


def missed_failures(test: Mapping[str, Any]) -> str:
    """Percent of the test episodes that failed unforeseen, and of those that failed: of none nothing is known."""
    shares: Any = test.get("confusion_pct")  # older cards lack it
    if not are_rows([shares], 4):
        return f"{test['missed_failures_pct']:.1f} %"
    failed = shares[0] + shares[2]
    return f"{test['missed_failures_pct']:.1f} % of {failed:.1f} %" if failed > 0 else "none failed in the test"


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
