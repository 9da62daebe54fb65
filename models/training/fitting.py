"""Fits a learner to examples, and its errors on others."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.models.episodes.examples import Examples
from tailor.models.features.features import FeatureSpace

Array = NDArray[np.float64]


def fitted(
    learner: Any,
    rows: Examples,
    space: FeatureSpace,
    kinds: Mapping[int, int] | None = None,
    choices: Examples | None = None,
) -> Any:
    """The learner itself, fitted.

    If it has intervals, `kinds` are those of its episodes, by their numbers, and `choices` correct the intervals.
    """
    known: dict[str, Any] = {}
    if kinds is not None:
        known["kinds"] = np.array([kinds[number] for number in rows.groups.tolist()])
    if choices is not None:
        known["choices"] = space(choices.arguments), choices.targets
    return learner.fit(space(rows.arguments), rows.targets, groups=rows.groups, **known)


def absolute_errors(learner: Any, rows: Examples, space: FeatureSpace) -> Array:
    """Absolute errors of the predictions, shape (n,)."""
    errors: Array = np.abs(learner.predict(space(rows.arguments)) - rows.targets)
    return errors
