"""The kitchen robot's belief of its own place, and of its gripper."""

from dataclasses import replace

import pytest

from tailor.executive import domains
from tailor.executive.interfaces.domain_results import kept_at, relocations
from tailor.schemas.messages import PoseEstimate, Sample

PERIOD_NS = 100_000_000


def test_a_base_that_was_moved_is_believed_after_three_poses_and_counted():
    kitchen = domains.load("kitchen")
    belief, counts = kitchen.initial_belief(), []
    for n, x in enumerate([0.0] * 8 + [2.0] * 4 + [-1.0] * 3, start=1):
        pose = Sample("b21/pose", PoseEstimate(0, x, 0.0, 0.0, 1e-4, 1e-4, 1e-4), n * PERIOD_NS, n)
        belief = kitchen.update(belief, n * PERIOD_NS, (pose,), (0.0,) * len(kitchen.axes))
        counts.append(relocations(kitchen, belief))
    assert counts == [0] * 10 + [1] * 4 + [2]


@pytest.mark.parametrize(
    ("width", "force", "expected"), [(0.07, 3.0, 0.07), (0.07, 30.0, 0.066), (0.002, 30.0, 0.0), (0.1203, 0.0, 0.1203)]
)
def test_the_gripper_stays_as_wide_as_it_is_and_goes_on_pressing(width, force, expected):
    kitchen = domains.load("kitchen")
    belief = replace(kitchen.initial_belief(), width=width, force=force)
    assert kept_at(kitchen, belief) == pytest.approx((*(0.0,) * 8, expected))
