"""What people are told of a model's test is no more than the test shows."""

import pytest

from tailor.models.runtime import load_model
from tailor.tools.hub.model_card import model_card
from tailor.tools.learning.card_lines import missed_failures


@pytest.mark.parametrize(
    ("entries", "text"),
    [
        ({"confusion_pct": [0.5, 0.25, 0.25, 99.0]}, "0.2 % of 0.8 %"),
        ({"confusion_pct": [0.0, 0.0, 0.0, 100.0], "missed_failures_pct": 0.0}, "none failed in the test"),
        ({}, "0.2 %"),
        ({"confusion_pct": "of another tool"}, "0.2 %"),
    ],
)
def test_missed_failures_are_told_with_those_that_could_be_missed(entries, text) -> None:
    """Of 300 approaches two fail, and neither may be among the 75 of the test: 0 % missed says nothing then."""
    assert missed_failures({"missed_failures_pct": 0.25, **entries}) == text


def test_a_shared_card_claims_no_check_that_nothing_does() -> None:
    """A model predicts beyond the ranges that it was trained in; nothing marks that."""
    card = load_model("agilo/goToPose/duration").card
    text = model_card("agilo", [card], "apache-2.0")
    assert "invalid" not in text
    assert "trained and tested within these ranges" in text
