"""Scales of random steps: as many in each order of magnitude, from one seed the same on every CPU."""

import numpy as np
import pytest

from tailor.executive.refinement.solvers.random_scales import random_scales


@pytest.mark.parametrize("decades", [1.0, 3.5, 4.0])
def test_every_decade_has_as_many_scales(decades):
    scales = random_scales(decades, np.random.default_rng(3), 20_000)
    assert scales.shape == (20_000,)
    assert 10.0**-decades * (1 - 1e-12) <= scales.min() <= scales.max() <= 1.0
    counts, _ = np.histogram(-np.log10(scales), bins=round(2 * decades), range=(0.0, decades))
    share = counts / 20_000 * round(2 * decades)
    assert (share > 0.9).all(), share
    assert (share < 1.1).all(), share


def test_scales_are_products_of_exact_operations():
    """Written out with Python's own numbers, whose arithmetic no vector instruction changes."""
    drawn = np.random.default_rng(5).random((3, 4)) * (2.0 * 3.321928094887362)
    expected = [[(1.0 - 0.5 * (x - x // 1)) / 2.0 ** int(x) for x in row] for row in drawn.tolist()]
    assert random_scales(2.0, np.random.default_rng(5), (3, 4)).tolist() == expected


def test_no_decades_are_the_whole_range_alone():
    assert random_scales(0.0, np.random.default_rng(0), 3).tolist() == [1.0, 1.0, 1.0]
