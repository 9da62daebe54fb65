"""A weighted mean of learners, chosen by cross-validation: a single learner, or the stack of bag and network."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from sklearn.utils.validation import check_is_fitted, validate_data

from tailor.models.episodes.episode_groups import episode_indices
from tailor.models.regression.network import DEEP, NetworkRegressor
from tailor.models.regression.out_of_fold import held_out_parts, out_of_fold
from tailor.models.trees.model_tree import BaggedModelTrees
from tailor.models.trees.regression_model import RegressionModel

Array = NDArray[np.float64]

STACK = "stack"
MEMBERS: Mapping[str, Callable[[int], RegressionModel]] = {
    "bag": lambda seed: BaggedModelTrees(random_state=seed),
    "network": lambda seed: NetworkRegressor(random_state=seed),
    "deep-network": lambda seed: NetworkRegressor(**DEEP, random_state=seed),
}
# in the order of their cost; a costlier one must be better by this share of the error
STACKED = ("bag", "network")
CANDIDATES = (*STACKED, STACK)
MIN_GAIN = 0.03
MIN_WEIGHT = 0.02  # a member with less is left out: it costs more than it gains


class BlendedRegressor(RegressionModel):
    """The best of some members, or of bag, network and their stack, by cross-validation over episodes (Wolpert 1992).

    Every candidate is a weighted mean of the members. The standard deviation is that of the mixture: the members' own,
    and their disagreement.

    Args:
      candidates: Names to choose from: a member, or "stack" for the weights with the least squared error.
      weights: Weights by member, to use without a choice.
      random_state: Seed of folds and members.
    """

    def __init__(
        self,
        candidates: Sequence[str] = CANDIDATES,
        weights: Mapping[str, float] | None = None,
        random_state: int = 0,
    ) -> None:
        self.candidates = candidates
        self.weights = weights
        self.random_state = random_state

    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit to features (n, f) and seconds (n,); see `RegressionModel.fit`.

        Raises:
          ValueError: The rows are not finite numbers.
        """
        X, y = validate_data(self, X, y, y_numeric=True, dtype=np.float64)
        episodes = episode_indices(groups, len(y))
        if self.weights is None:
            self._choose(X, y, episodes)
        else:
            self.weights_ = dict(self.weights)
        self.members_ = {name: MEMBERS[name](self.random_state).fit(X, y, groups=episodes) for name in self.weights_}
        return self

    def predict_with_std(self, X: Any) -> tuple[Array, Array]:
        """Seconds and the standard deviation of the mixture, shapes (n,)."""
        check_is_fitted(self)
        X = validate_data(self, X, dtype=np.float64, reset=False)
        return mixture([member.predict_with_std(X) for member in self.members_.values()], list(self.weights_.values()))

    def frozen(self) -> BlendedRegressor:
        """An unfitted copy that keeps the chosen weights."""
        return BlendedRegressor(self.candidates, self.weights_, self.random_state)

    def _choose(self, X: Array, y: Array, episodes: NDArray[np.int64]) -> None:
        """Set the weights, the errors of all candidates, and the chosen one's predictions out of fold."""
        names = STACKED if STACK in self.candidates else tuple(self.candidates)
        seed = self.random_state
        apart = {name: out_of_fold(partial(MEMBERS[name], seed), X, y, episodes, seed) for name in names}
        means = np.column_stack([mean for mean, _ in apart.values()])
        weights = {name: np.eye(len(names))[names.index(name)] for name in names}
        unseen = {name: means[:, k] for k, name in enumerate(names)}
        if STACK in self.candidates:
            weights[STACK] = _stacked(means, y)
            unseen[STACK] = _cross_validated_stack(means, y, episodes, seed)
        self.cv_mae_ = {name: float(np.abs(unseen[name] - y).mean()) for name in self.candidates}
        self.chosen_ = _best(self.cv_mae_)
        chosen = dict(zip(names, weights[self.chosen_], strict=True))
        self.weights_ = {name: float(weight) for name, weight in chosen.items() if weight > 0}
        self.out_of_fold_ = mixture([apart[name] for name in self.weights_], list(self.weights_.values()))


def mixture(parts: Sequence[tuple[Any, Any]], weights: Sequence[float]) -> tuple[Array, Array]:
    """Mean and standard deviation of a mixture of distributions, each given by its mean and deviation, (n,)."""
    mean = sum(weight * part for weight, (part, _) in zip(weights, parts, strict=True))
    square = sum(weight * (std**2 + (part - mean) ** 2) for weight, (part, std) in zip(weights, parts, strict=True))
    return np.asarray(mean), np.sqrt(square)


def _stacked(means: Array, y: Array) -> Array:
    """Convex weights of the two columns of `means`, (n, 2), with the least squared error."""
    apart = means[:, 0] - means[:, 1]
    share = float(np.dot(y - means[:, 1], apart) / max(np.dot(apart, apart), np.finfo(float).tiny))
    share = min(max(share, 0.0), 1.0)
    share = round(share) if min(share, 1 - share) < MIN_WEIGHT else share
    return np.array([share, 1 - share])


def _cross_validated_stack(means: Array, y: Array, episodes: NDArray[np.int64], seed: int) -> Array:
    unseen = np.empty(len(y))
    for apart in held_out_parts(episodes, seed):
        unseen[apart] = means[apart] @ _stacked(means[~apart], y[~apart])
    return unseen


def _best(errors: Mapping[str, float]) -> str:
    """The first candidate that no later one beats by MIN_GAIN."""
    best, *later = errors
    for name in later:
        if errors[name] < (1 - MIN_GAIN) * errors[best]:
            best = name
    return best
