"""Poses behind the ball lie within the bounds of their interval form."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tailor.executive.domains.soccer.action_library import behind_both, behind_goal


@given(st.integers(0, 2**32 - 1), st.sampled_from([behind_goal, behind_both]), st.sampled_from([0.0, 0.01, 1.0, 9.0]))
def test_poses_of_all_places_in_a_box_lie_in_its_image(seed, behind, width):
    rng = np.random.default_rng(seed)
    lower = rng.uniform(-7, 7, 8)
    upper = lower + width * rng.random(8)
    drawn = behind(lower + rng.random((200, 8)) * (upper - lower))
    low, high = behind.spans(tuple(map(np.asarray, lower)), tuple(map(np.asarray, upper)))
    assert (drawn >= np.array(low) - 1e-12).all()
    assert (drawn <= np.array(high) + 1e-12).all()
    ends = behind(np.vstack([lower, upper]))
    if width == 0.0:
        np.testing.assert_allclose(ends, [low, high], atol=1e-12)
