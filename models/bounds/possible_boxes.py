"""Selects the boxes for which a case of the features is possible, so that no others are bounded."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.models.features.intervals import Array, Span
from tailor.models.features.sight_intervals import Spans

MIN_SELECTION = 200  # pairs of boxes, by case; below, selecting the possible ones costs more than it saves


def select_possible(features: Spans, possible: NDArray[np.bool_]) -> tuple[Spans, Any]:
    """The features of those cases and boxes that are possible at all, and their indices.

    All of them if there are fewer than MIN_SELECTION; arrays that do not vary along an axis stay as they are.
    """
    if possible.size < MIN_SELECTION or possible.all():
        return features, ...
    place = tuple(np.flatnonzero(possible.any(axis=other)) for other in ((1, 2), (0, 2), (0, 1)))
    return tuple(Span(_taken(span.lower, place), _taken(span.upper, place)) for span in features), np.ix_(*place)


def _taken(values: Array, place: tuple[NDArray[np.intp], ...]) -> Array:
    for axis, chosen in enumerate(place):
        if values.shape[axis] > 1:
            values = values.take(chosen, axis)
    return values
