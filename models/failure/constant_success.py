"""The success of an action whose episodes hardly differ in it: one probability, whatever the arguments."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from sklearn.utils.multiclass import check_classification_targets
from sklearn.utils.validation import validate_data

from tailor.models.failure.failure_model import FailureTrees, Floats, Ints
from tailor.models.fitted_trees.sklearn_trees import Step
from tailor.models.fitted_trees.split_tree import LEAF, SplitTree


class ConstantSuccess(FailureTrees):
    """A tree of one leaf: the share of successes, with half a success and half a failure more, so never certain.

    Other learners need episodes of both outcomes; a good controller may not fail once in a hundred.

    Args:
      cost_ratio: Cost of a missed failure over that of a false alarm.
    """

    def __init__(self, cost_ratio: float = 1.0) -> None:
        self.cost_ratio = cost_ratio

    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit to outcomes, 0 or 1, of which one may be missing; see `FailureModel.fit`."""
        X, y = validate_data(self, X, y, dtype=np.float64)
        check_classification_targets(y)
        self.classes_ = np.array([0, 1])
        self.steps_ = self._fitted(X.astype(np.float32), y, np.arange(len(y)))
        return self

    def _fitted(self, features: Floats, success: Ints, episodes: Ints) -> list[Step]:
        share = (success.sum() + 0.5) / (len(success) + 1)
        return [(SplitTree.of([(LEAF, 0.0, 0, 0, 0)]), np.array([share], np.float32))]
