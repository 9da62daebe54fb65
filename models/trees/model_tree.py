"""Model trees (paper 5.2) as scikit-learn estimators: one tree, and a bag of trees over resampled episodes."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from sklearn.utils.validation import check_is_fitted, validate_data

from tailor.models.episodes.episode_groups import bootstrap_weights, episode_indices, held_out_rows
from tailor.models.fitted_trees.linear_tree import LinearTree
from tailor.models.trees.linear_variant import TreeSettings, fit_linear
from tailor.models.trees.m5_variant import fit_m5
from tailor.models.trees.regression_model import RegressionModel

Floats = NDArray[np.float32]
Array = NDArray[np.float64]
Generator = np.random.Generator


class _TreeRegressor(RegressionModel):
    """Base of one tree and a bag: settings, validation, and episodes as groups."""

    def __init__(
        self,
        max_leaves: int = 64,
        min_rows: float = 40.0,
        smoothing: float = 0.0,
        ridge: float = 1e-4,
        bins: int = 128,
        clip: bool = True,
        random_state: int | Generator | None = 0,
        huber: float = 0.0,
    ) -> None:
        self.max_leaves = max_leaves
        self.min_rows = min_rows
        self.smoothing = smoothing
        self.ridge = ridge
        self.bins = bins
        self.clip = clip
        self.random_state = random_state
        self.huber = huber

    def _settings(self, rows: int) -> TreeSettings:
        min_rows = min(self.min_rows, max(2.0, rows / 16))  # small data sets may split, too
        return TreeSettings(self.max_leaves, min_rows, self.smoothing, self.ridge, self.bins, self.clip, self.huber)

    def _checked(self, X: Any, y: Any, groups: Any) -> tuple[Floats, Array, NDArray[np.int64]]:
        X, y = validate_data(self, X, y, y_numeric=True, dtype=np.float64)
        return X.astype(np.float32), y.astype(np.float64), episode_indices(groups, len(y))

    def _features(self, X: Any) -> Floats:
        check_is_fitted(self)
        return np.asarray(validate_data(self, X, dtype=np.float64, reset=False), np.float32)


class ModelTreeRegressor(_TreeRegressor):
    """A regression tree with a linear formula in each leaf (paper 5.2).

    Args:
      variant: "linear" chooses splits by the error of linear fits on both sides, and the size on held-out episodes.
        "m5" is Quinlan's M5' as in WEKA: splits by standard deviation, pruned by error estimate, smoothed with k = 15.
      held_out: Share of episodes that choose the size of a linear tree, 0..1; the final fit uses them, too.
      max_leaves, min_rows, smoothing, ridge, bins, clip, huber: See `TreeSettings`; m5 uses `clip` only.
      random_state: Seed or generator that draws the held-out episodes.
    """

    def __init__(
        self,
        variant: str = "linear",
        held_out: float = 0.25,
        max_leaves: int = 64,
        min_rows: float = 40.0,
        smoothing: float = 0.0,
        ridge: float = 1e-4,
        bins: int = 128,
        clip: bool = True,
        random_state: int | Generator | None = 0,
        huber: float = 0.0,
    ) -> None:
        super().__init__(max_leaves, min_rows, smoothing, ridge, bins, clip, random_state, huber)
        self.variant = variant
        self.held_out = held_out

    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit to features (n, f) and seconds (n,); see `RegressionModel.fit`.

        Raises:
          ValueError: The rows are not finite numbers, or the variant is unknown.
        """
        features, targets, episodes = self._checked(X, y, groups)
        if self.variant == "m5":
            self.tree_ = fit_m5(features, targets, self.clip)
        elif self.variant == "linear":
            held = held_out_rows(episodes, self.held_out, self.random_state)
            self.tree_ = fit_linear(features, targets, np.ones(len(targets)), held, self._settings(len(targets)))
        else:
            raise ValueError(f"variant '{self.variant}' is unknown (expected: linear, m5)")
        return self

    def predict_with_std(self, X: Any) -> tuple[Floats, Floats]:
        """Seconds and the standard deviation of the training rows in the leaf, shapes (n,)."""
        features = self._features(X)
        return self.tree_.predict(features), self.tree_.std[self.tree_.splits.leaf_of(features)]

    @property
    def trees_(self) -> list[LinearTree]:
        """The tree as a list, as a bag has it."""
        return [self.tree_]


class BaggedModelTrees(_TreeRegressor):
    """Model trees over resampled episodes: the mean predicts, the standard deviation measures its uncertainty.

    Each tree is fitted to a bootstrap sample of the episodes; those not drawn choose its size.

    Args:
      trees: Number of trees.
      max_leaves, min_rows, smoothing, ridge, bins, clip, huber: See `TreeSettings`.
      random_state: Seed or generator that draws the episodes.
    """

    def __init__(
        self,
        trees: int = 10,
        max_leaves: int = 64,
        min_rows: float = 40.0,
        smoothing: float = 0.0,
        ridge: float = 1e-4,
        bins: int = 64,
        clip: bool = True,
        random_state: int | Generator | None = 0,
        huber: float = 0.0,
    ) -> None:
        super().__init__(max_leaves, min_rows, smoothing, ridge, bins, clip, random_state, huber)
        self.trees = trees

    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit to features (n, f) and seconds (n,); see `RegressionModel.fit`.

        Raises:
          ValueError: The rows are not finite numbers.
        """
        features, targets, episodes = self._checked(X, y, groups)
        rng = np.random.default_rng(self.random_state or 0)
        settings = self._settings(len(targets))
        self.trees_ = []
        for _ in range(self.trees):
            weights = bootstrap_weights(episodes, rng)
            self.trees_.append(fit_linear(features, targets, weights, weights == 0, settings))
        return self

    def predict_with_std(self, X: Any) -> tuple[Floats, Floats]:
        """Seconds and the standard deviation over the trees, shapes (n,)."""
        features = self._features(X)
        each = np.stack([tree.predict(features) for tree in self.trees_], axis=1)
        return each.mean(axis=1), each.std(axis=1)
