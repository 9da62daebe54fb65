"""Whether a card says what a card says, in the right shape: what loading, listing and drawing read. No dependencies."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

OUTPUTS = {
    "duration": ["mean_s", "std_s"],
    "energy": ["mean_j", "std_j"],
    "success": ["success"],
    "benefit": ["slower"],
}
THRESHOLDED = ("success", "benefit")
FIGURES = {  # of the test, that every list of models tells
    "duration": ("mae_s", "mean_duration_s"),
    "energy": ("mae_j", "mean_energy_j"),
    "success": ("accuracy_pct", "missed_failures_pct"),
    "benefit": ("right_pct", "slower_pct"),
}


def card_error(card: Mapping[str, Any]) -> str:
    """What is wrong with a card that has all its fields, and what was expected; empty if nothing is."""
    for name in ("robot", "action", "kind", "features", "sha256", "command"):
        if not isinstance(card[name], str) or not card[name]:
            return f"{name} is {_short(card[name])}, expected text"
    if card["kind"] not in OUTPUTS:
        return f"kind is '{card['kind']}', expected one of: {', '.join(OUTPUTS)}"
    for name in ("episodes", "learner", "test", "golden", "versions", *(["feature_units"] * ("feature_units" in card))):
        if not isinstance(card[name], dict):
            return f"{name} is {_short(card[name])}, expected an object"
    return _arguments_error(card["arguments"]) or _answers_error(card) or _golden_error(card) or _told_error(card)


def _arguments_error(said: Any) -> str:
    if not isinstance(said, list) or not said:
        return f"arguments is {_short(said)}, expected a list of name, unit, lower, upper"
    for each in said:
        named = isinstance(each, dict) and all(isinstance(each.get(key), str) for key in ("name", "unit"))
        if not named or not _is_range([each.get("lower"), each.get("upper")]):
            return f"argument {_short(each)}, expected name, unit, and numbers lower <= upper"
    return ""


def _answers_error(card: Mapping[str, Any]) -> str:
    expected = OUTPUTS[card["kind"]]
    if card["outputs"] != expected:
        return f"outputs is {_short(card['outputs'])}, expected {expected} of a model of {card['kind']}"
    if not _is_range(card["output_range"]):
        return f"output_range is {_short(card['output_range'])}, expected two numbers, the lower one first"
    if card["kind"] in THRESHOLDED and not _is_number(card.get("threshold")):
        return f"threshold is {_short(card.get('threshold'))}, expected a number"
    return ""


def _golden_error(card: Mapping[str, Any]) -> str:
    width, rows = len(card["arguments"]), card["golden"].get("arguments")
    whole = isinstance(rows, list) and rows and all(isinstance(row, list) and len(row) == width for row in rows)
    if not whole or not all(_is_number(value) for row in rows for value in row):
        return f"golden arguments are {_short(rows)}, expected rows of {width} numbers"
    for name in card["outputs"]:
        values = card["golden"].get(name)
        if not isinstance(values, list) or len(values) != len(rows) or not all(map(_is_number, values)):
            return f"golden {name} is {_short(values)}, expected {len(rows)} numbers"
    return ""


def _told_error(card: Mapping[str, Any]) -> str:
    """What lists and pages of models tell of it."""
    if not isinstance(card["learner"].get("name"), str):
        return f"learner's name is {_short(card['learner'].get('name'))}, expected text"
    if not _is_number(card["episodes"].get("count")):
        return f"episodes' count is {_short(card['episodes'].get('count'))}, expected a number"
    for name in FIGURES[card["kind"]]:
        if not _is_number(card["test"].get(name)):
            return f"test's {name} is {_short(card['test'].get(name))}, expected a number"
    return ""


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _is_range(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(map(_is_number, value)) and value[0] <= value[1]


def _short(value: Any) -> str:
    said = repr(value)
    return said if len(said) <= 60 else f"{said[:57]}..."
