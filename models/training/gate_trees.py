"""Grows trees that say how risky refining is: the share of what was at stake that refining lost, leaf by leaf.

One episode in ten that loses a tick is no reason to forgo nine that win seconds, so pairs count by their stake.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from sklearn.tree import DecisionTreeClassifier

from tailor.models.trees.sklearn_trees import Step, shares_of, splits_of

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

TREES = 48
LEAF_SHARE = 0.06  # of the pairs in each leaf at least: slower ones are few, and mostly noise
RULES = 4  # of the single tree, as in the paper


@dataclass(frozen=True, slots=True)
class RiskTrees:
    """Trees whose mean is the risk, 0..1."""

    steps: Sequence[Step]  # a leaf says the weighted share of slower pairs

    @property
    def leaves(self) -> list[int]:
        """Of each tree."""
        return [splits.leaves for splits, _ in self.steps]

    def risk(self, situations: Array) -> Array:
        """Shape (n,), of situations (n, k)."""
        rows = situations.astype(np.float32)
        said = [shares[splits.leaf_of(rows)] for splits, shares in self.steps]
        return np.mean(said, axis=0, dtype=np.float32).astype(np.float64)


def grow_forest(situations: Array, slower: Bools, stakes: Array, rng: np.random.Generator) -> RiskTrees:
    """Trees over resampled pairs, each split chosen among half of the columns."""
    count, steps = len(slower), []
    for _ in range(TREES):
        times = np.bincount(rng.integers(0, count, count), minlength=count)
        drawn = np.flatnonzero(times)
        tree = DecisionTreeClassifier(
            min_samples_leaf=_least(count), max_features=0.5, random_state=int(rng.integers(2**31))
        ).fit(situations[drawn], slower[drawn], (stakes * times)[drawn])
        steps.append((splits_of(tree), shares_of(tree)))
    return RiskTrees(steps)


def grow_tree(situations: Array, slower: Bools, stakes: Array, rng: np.random.Generator) -> RiskTrees:
    """One tree of four rules; nothing in it is drawn."""
    tree = DecisionTreeClassifier(max_leaf_nodes=RULES, min_samples_leaf=_least(len(slower)), random_state=0)
    tree.fit(situations, slower, stakes)
    return RiskTrees([(splits_of(tree), shares_of(tree))])


Grower = Callable[[Array, Bools, Array, np.random.Generator], RiskTrees]
LEARNERS: Mapping[str, Grower] = {"forest": grow_forest, "tree": grow_tree}


def _least(count: int) -> int:
    return max(1, round(LEAF_SHARE * count))
