"""The rule that applied: of the tree that speaks for all, with the conditions that the features meet."""

import numpy as np
import pytest

from tailor.models.bounds.tree_boxes import TreeBoxes
from tailor.models.features.features import Quantity
from tailor.models.features.spaces import feature_space
from tailor.models.rules.leaf_rules import applied_rule
from tailor.models.runtime import load_model

QUANTITIES = (Quantity("dist", "m"), Quantity("angle_to", "rad"))
INF = np.inf


def boxes() -> TreeBoxes:
    """Three trees: one leaf that says 1 s, one that says 9 s, and two leaves that part at 2 m."""
    lower = np.array([[-INF, -INF], [-INF, -INF], [-INF, -INF], [2.0, -INF]], np.float32)
    upper = np.array([[INF, INF], [INF, INF], [2.0, INF], [INF, INF]], np.float32)
    slopes = np.array([[0, 0], [0, 0], [0, 0], [1, 0]], np.float32)
    intercept, low = np.array([1, 9, 3, 2], np.float32), np.zeros(4, np.float32)
    return TreeBoxes(np.array([0, 1, 2]), lower, upper, slopes, intercept, low, low + 20)


@pytest.mark.parametrize(
    ("dist", "rule"),
    [
        (1.0, "if dist <= 2.00 m then time = 3 s   [0.0 .. 20.0 s] (tree 3 of 3"),
        (2.0, "if dist <= 2.00 m then"),  # on the threshold
        (2.5, "if dist > 2.00 m then time = 2 s + 1 s/m · dist   [0.0 .. 20.0 s] (tree 3 of 3"),
        (8.5, "if in all cases then time = 9 s"),  # this tree's 10.5 s are farther from the mean of 6.8 s
    ],
)
def test_the_rule_is_of_the_tree_that_says_nearest_to_the_mean(dist: float, rule: str) -> None:
    assert applied_rule(boxes(), np.array([dist, 0.1], np.float32), QUANTITIES, "s").startswith(rule)


def test_a_quantity_without_a_unit_is_a_plain_number() -> None:
    bare = (Quantity("out", "1"), Quantity("angle_to", "rad"))
    rule = applied_rule(boxes(), np.array([2.5, 0.1], np.float32), bare, "s")
    assert rule.startswith("if out > 2.00 then time = 2 s + 1 s · out ")


def test_what_is_not_a_number_meets_no_rule() -> None:
    assert applied_rule(boxes(), np.array([np.nan, 0.1], np.float32), QUANTITIES, "s") == ""


def test_a_shipped_model_of_trees_has_a_rule_for_whatever_it_is_asked() -> None:
    model = load_model("b21/reach/duration")
    space = feature_space(model.card["features"])
    for row in space(np.array(model.card["golden"]["arguments"])):
        assert applied_rule(model.bounds.trees.boxes, row, space.features, "s").startswith("if ")
