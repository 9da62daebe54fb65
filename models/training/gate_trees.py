"""Trees that predict the risk of refinement: the share of the stakes that refinement lost, leaf by leaf.

Pairs are weighted by their stake: one episode in ten that loses a tick does not outweigh nine that gain seconds.
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
LEAF_SHARE = 0.06  # minimum share of the pairs in a leaf: slower ones are few, and mostly noise
RULES = 4  # leaves of the single tree, as in the paper


@dataclass(frozen=True, slots=True)
class RiskTrees:
    """Trees whose mean is the risk, 0..1."""

    steps: Sequence[Step]  # a leaf holds the weighted share of slower pairs

    @property
    def leaves(self) -> list[int]:
        """Number of leaves of each tree."""
        return [splits.leaves for splits, _ in self.steps]

    def risk(self, situations: Array) -> Array:
        """Risk, 0..1, shape (n,), of situations (n, k)."""
        rows = situations.astype(np.float32)
        each = np.stack([shares[splits.leaf_of(rows)] for splits, shares in self.steps])
        return np.asarray(np.mean(each, axis=0, dtype=np.float32).astype(np.float64))


def grow_forest(situations: Array, slower: Bools, stakes: Array, rng: np.random.Generator) -> RiskTrees:
    """Trees over resampled pairs; each split considers half of the columns.

    Args:
      situations: Shape (n, k).
      slower: Whether refinement was slower, shape (n,).
      stakes: Weight of each pair, shape (n,).
      rng: Draws pairs and columns.
    """
    count, steps = len(slower), []
    for _ in range(TREES):
        times = np.bincount(rng.integers(0, count, count), minlength=count)
        drawn = np.flatnonzero(times)
        tree = DecisionTreeClassifier(
            min_samples_leaf=_min_rows(count), max_features=0.5, random_state=int(rng.integers(2**31))
        ).fit(situations[drawn], slower[drawn], (stakes * times)[drawn])
        steps.append((splits_of(tree), shares_of(tree)))
    return RiskTrees(steps)


def grow_tree(situations: Array, slower: Bools, stakes: Array, rng: np.random.Generator) -> RiskTrees:
    """One tree of four rules; deterministic. Arguments as for `grow_forest`."""
    tree = DecisionTreeClassifier(max_leaf_nodes=RULES, min_samples_leaf=_min_rows(len(slower)), random_state=0)
    tree.fit(situations, slower, stakes)
    return RiskTrees([(splits_of(tree), shares_of(tree))])


Grower = Callable[[Array, Bools, Array, np.random.Generator], RiskTrees]
LEARNERS: Mapping[str, Grower] = {"forest": grow_forest, "tree": grow_tree}


def _min_rows(count: int) -> int:
    return max(1, round(LEAF_SHARE * count))
