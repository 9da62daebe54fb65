"""What the kitchen's sampler makes of a run: training examples of drives that are decided anew on the way."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("pybullet")

from tailor.executive import domains
from tailor.executive.belief.planar_ekf import Pose
from tailor.tools.lockstep.task_sampler import sampler_of

EXACT = (1e-8, 0.0, 0.0, 1e-8, 0.0, 1e-8)


@pytest.mark.parametrize("seen", [0.0, 1.0])
def test_an_example_on_the_way_keeps_the_goal_and_what_had_been_seen(seen):
    kitchen = domains.load("kitchen")
    belief = replace(kitchen.initial_belief(), pose=Pose(0.4, -0.2, 0.1, EXACT), v=0.3)
    arguments = np.array([0.0, 0.0, 0.0, 0.0, 1.5, 0.3, 0.2, 0.25, seen])
    example = sampler_of(kitchen).arguments_now(kitchen.actions["goToPose"], belief, arguments)
    assert example == [0.4, -0.2, 0.1, 0.3, 1.5, 0.3, 0.2, 0.25, seen]
