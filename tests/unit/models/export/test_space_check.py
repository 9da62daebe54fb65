"""A feature space is computed and exported before anything is learned in it."""

import numpy as np
import pytest

from tailor.models.episodes.episodes import Episode
from tailor.models.export.space_check import fault_in_data, fault_of_space
from tailor.models.features.features import FeatureSpace, quantities
from tailor.models.features.spaces import feature_spaces

TWO = quantities("a:m b:m")
OPERATORS = {
    "numbers on the left": lambda r, ops: ops.stack(2.0 + r[[0]], 2.0 * r[[1]]),
    "quotients": lambda r, ops: ops.stack(r[[0]] / 3.0, r[[0]] / r[[1]]),
    "signs": lambda r, ops: ops.stack(-r[[0]], 1.0 - r[[1]]),
    "comparisons": lambda r, ops: ops.stack(
        ops.where(r[[0]] > 0.2, r[[0]], r[[1]]), ops.where(r[[0]] < 0.0, -1.0, r[[1]])
    ),
    "limits": lambda r, ops: ops.stack(ops.higher(r[[0]], 0.01), ops.lower(r[[1]], 0.01)),
}
FAULTS = {
    "no feature of its own": (lambda r, ops: np.sin(r), "cannot be exported, expected arithmetic, row indices"),
    "a missing feature": (lambda r, ops: r[[0]], "computes an array of shape (64, 1), expected (64, 2)"),
    "a missing argument": (lambda r, ops: r[[0, 7]], "IndexError: index 7 is out of bounds"),
    "a row instead of rows": (lambda r, ops: ops.stack(r[0], r[1]), "a is another number when exported"),
    "double precision": (lambda r, ops: r * np.float64(2), "computes float64, expected float32"),
}


def two_features(rows):
    return FeatureSpace("mine", TWO, TWO, rows)


@pytest.mark.parametrize("name", OPERATORS)
def test_arithmetic_is_the_same_when_exported(name):
    assert fault_of_space(two_features(OPERATORS[name])) == ""


@pytest.mark.parametrize("name", feature_spaces())
def test_every_space_that_ships_is_the_same_when_exported(name):
    assert fault_of_space(feature_spaces()[name]) == ""


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_one_line_that_names_the_space(name):
    rows, fault = FAULTS[name]
    found = fault_of_space(two_features(rows))
    assert found.startswith("feature space 'mine'")
    assert fault in found
    assert "\n" not in found


def test_a_feature_that_is_no_number_in_the_data_is_named_with_its_arguments():
    space = two_features(lambda r, ops: ops.stack(r[[0]], ops.sqrt(r[[1]])))
    good, bad = np.array([[1.0, 4.0]]), np.array([[1.0, 4.0], [2.0, -9.0]])
    episodes = [Episode(k, rows[0], rows, 1.0, True, "") for k, rows in enumerate((good, bad))]
    assert fault_in_data(space, episodes[:1]) == ""
    assert fault_in_data(space, episodes) == (
        "feature space 'mine': b is nan in episode 1, expected a number; a = 2, b = -9"
    )
