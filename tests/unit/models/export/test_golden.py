"""The golden examples of a card are arguments that can occur, whatever the order of an action's arguments."""

from types import SimpleNamespace

import numpy as np

from tailor.models.episodes.episodes import DataSet, Episode
from tailor.models.export.publishing import Publication, golden
from tailor.models.features.features import FeatureSpace, quantities

NAMES = "x:m y:m u:m/s xg:m yg:m cx:m/s"  # three of the start, two of the goal, and the water
SPACE = FeatureSpace("afloat", quantities(NAMES), quantities(NAMES), lambda rows, ops: rows)
LEARNER = SimpleNamespace(predict_proba=lambda features: np.ones((len(features), 2)))


def test_at_zero_distance_each_goal_is_at_the_start_of_its_name():
    row = np.array([1.0, 2.0, 0.5, 4.0, 5.0, -0.1])
    names = [{"name": quantity.name} for quantity in SPACE.arguments]
    data = DataSet({"arguments": names}, (Episode(0, row, row[None, :], 1.0, True, ""),), "")
    made = golden(data, LEARNER, Publication("success", "constant", SPACE, 1, ""))
    assert made["arguments"][0] == row.tolist()
    assert made["arguments"][-1] == [1.0, 2.0, 0.5, 1.0, 2.0, -0.1]
