"""Coverage of the intervals of a rare action: what no episode tells is unknown, and said without a warning."""

import warnings

import numpy as np
import pytest

from tailor.tools.evaluations.models.coverage import Predicted, coverage_columns


@pytest.mark.parametrize("count", [1, 2])
def test_a_third_without_an_episode_is_unknown(count: int) -> None:
    one = np.ones(count)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        columns = coverage_columns(Predicted(one, one, 0.5 * one, 1.5 * one), one)
    assert columns["coverage_pct"] == 100.0
    assert columns["coverage_thirds_pct"] == pytest.approx([100.0] * count + [np.nan] * (3 - count), nan_ok=True)
