"""Checks that the entries of a card have the shape that loading, listing and drawing need."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tailor.models.cards.episodes_shape import episodes_error
from tailor.models.cards.json_shape import are_rows, arguments_error, is_number, is_range
from tailor.schemas.parsed_files import shown

OUTPUTS = {  # the second form is that of older models, without intervals
    "duration": (["mean_s", "lower_s", "upper_s"], ["mean_s", "std_s"]),
    "duration_beside": (["mean_s", "lower_s", "upper_s"],),
    "energy": (["mean_j", "lower_j", "upper_j"], ["mean_j", "std_j"]),
    "success": (["success"],),
    "clearance": (["success"],),
}
KINDS_WITH_THRESHOLD = ("success", "clearance")
TEST_FIGURES = {  # entries of the test that every list of models shows
    "duration": ("mae_s", "mean_duration_s"),
    "duration_beside": ("mae_s", "mean_duration_s"),
    "energy": ("mae_j", "mean_energy_j"),
    "success": ("accuracy_pct", "missed_failures_pct"),
    "clearance": ("accuracy_pct", "missed_failures_pct"),
}


def card_error(card: Mapping[str, Any]) -> str:
    """First error in a card that has all its entries; empty if there is none."""
    for name in ("robot", "action", "kind", "features", "sha256", "command"):
        if not isinstance(card[name], str) or not card[name]:
            return f"{name} is {shown(card[name])}, expected text"
    if card["kind"] not in OUTPUTS:
        return f"kind is '{card['kind']}', expected one of: {', '.join(OUTPUTS)}"
    for name in ("episodes", "learner", "test", "golden", "versions", *(["feature_units"] * ("feature_units" in card))):
        if not isinstance(card[name], dict):
            return f"{name} is {shown(card[name])}, expected an object"
    return arguments_error(card["arguments"]) or _outputs_error(card) or _golden_error(card) or _summary_error(card)


def _outputs_error(card: Mapping[str, Any]) -> str:
    expected = OUTPUTS[card["kind"]]
    if card["outputs"] not in expected:
        return f"outputs is {shown(card['outputs'])}, expected {expected[0]} of a model of {card['kind']}"
    if not is_range(card["output_range"]):
        return f"output_range is {shown(card['output_range'])}, expected two numbers, the lower one first"
    if card["kind"] in KINDS_WITH_THRESHOLD and not is_number(card.get("threshold")):
        return f"threshold is {shown(card.get('threshold'))}, expected a number"
    return ""


def _golden_error(card: Mapping[str, Any]) -> str:
    width, rows = len(card["arguments"]), card["golden"].get("arguments")
    if not rows or not are_rows(rows, width):
        return f"golden arguments are {shown(rows)}, expected rows of {width} numbers"
    for name in card["outputs"]:
        values = card["golden"].get(name)
        if not isinstance(values, list) or len(values) != len(rows) or not all(map(is_number, values)):
            return f"golden {name} is {shown(values)}, expected {len(rows)} numbers"
    return ""


def _summary_error(card: Mapping[str, Any]) -> str:
    """First error in the entries that lists and checks of models need."""
    if not isinstance(card["learner"].get("name"), str):
        return f"learner's name is {shown(card['learner'].get('name'))}, expected text"
    for name in TEST_FIGURES[card["kind"]]:
        if not is_number(card["test"].get(name)):
            return f"test's {name} is {shown(card['test'].get(name))}, expected a number"
    if not is_number(card["test"].get("interval90_factor", 1.0)):  # of models without intervals of their own
        return f"test's interval90_factor is {shown(card['test']['interval90_factor'])}, expected a number"
    return _pictures_error(card["test"]) or episodes_error(card["episodes"])


def _pictures_error(test: Mapping[str, Any]) -> str:
    """First error in the entries that pictures of models need; they may be missing."""
    for name, width in (("learning_curve", 2), ("reliability", 3)):
        if name in test and not are_rows(test[name], width):
            return f"test's {name} is {shown(test[name])}, expected rows of {width} numbers"
    if "learning_curve" in test and not is_range(test.get("mae_ci95")):
        return f"test's mae_ci95 is {shown(test.get('mae_ci95'))}, expected two numbers, the lower one first"
    return ""
