"""Learners by name, for durations and for successes; `tailor train --learner NAME`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from models.failure_forest import FailureForest
from models.failure_tree import FailureTree
from models.model_tree import BaggedModelTrees, ModelTreeRegressor
from schemas.errors import UsageError

COST_RATIO = 5.0  # a missed failure costs five false alarms, as WEKA's cost matrix in the paper does

DURATION: Mapping[str, Callable[[int], Any]] = {
    "bag": lambda seed: BaggedModelTrees(random_state=seed),
    "linear": lambda seed: ModelTreeRegressor("linear", random_state=seed),
    "m5": lambda seed: ModelTreeRegressor("m5", random_state=seed),
}
SUCCESS: Mapping[str, Callable[[int], Any]] = {
    "forest": lambda seed: FailureForest(cost_ratio=COST_RATIO, random_state=seed),
    "tree": lambda seed: FailureTree(COST_RATIO, random_state=seed),
}


def make(kind: str, name: str, seed: int) -> Any:
    """A fresh learner.

    Raises:
      UsageError: No learner of that name for that kind.
    """
    table = DURATION if kind == "duration" else SUCCESS
    if name not in table:
        raise UsageError(f"learner '{name}' is unknown for {kind} (expected one of: {', '.join(table)})")
    return table[name](seed)
