"""Drives to near stands: no loops before the table, no contact, at rest where they should be."""

import math
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("pybullet")

from tailor.executive.belief.angles import difference
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.kitchen.drive_to_stand import Far
from tailor.tools.lockstep import action_run

# start and goal before a table's edge; with bends into the goal they took 8 to 12 s and touched the furniture
NEAR = (
    ((-1.51, -0.21, 3.08), (-1.35, -0.03, -2.76)),
    ((-1.34, -0.06, -2.73), (-1.52, 0.13, 2.56)),
    ((-1.33, -0.43, -2.5), (-1.61, -0.43, -3.1)),
    ((1.7, -0.37, -0.35), (1.31, -0.48, -0.1)),
    ((1.7, -0.07, 0.17), (1.28, -0.15, -0.03)),
    ((0.41, 0.28, 1.92), (-0.01, 0.63, -0.51)),
)


@pytest.mark.parametrize(("start", "goal"), NEAR)
def test_a_drive_to_a_near_stand_touches_nothing_and_makes_no_loop(body, kitchen, start, goal):
    arguments = np.array([*start, 0.0, *goal, 0.0, 0.0])
    run = action_run.run_action(body, kitchen, "goToPose", arguments, np.random.default_rng(0), traced=True)
    end = run.trace[-1].truth
    assert run.failure == ""
    assert run.duration_s < 6.0
    assert math.dist((end.x, end.y), goal[:2]) < 0.05
    assert abs(difference(end.phi, goal[2])) < 0.15
    assert max(math.dist((tick.truth.x, tick.truth.y), start[:2]) for tick in run.trace) < 1.3 * math.dist(
        start[:2], goal[:2]
    )


@pytest.mark.parametrize(("seen", "least", "most"), [(1.0, 3.0, 5.0), (0.0, 6.0, 10.0)])
def test_it_backs_off_farther_than_a_metre_only_where_the_stool_has_been_seen(body, kitchen, seen, least, most):
    arguments = np.array([-1.5, -0.1, 3.1, 0.0, 0.1, 0.1, 3.0, 0.0, seen])
    run = action_run.run_action(body, kitchen, "goToPose", arguments, np.random.default_rng(0), traced=True)
    assert run.failure == ""
    assert least < run.duration_s < most
    backward = all(tick.truth.v < 0.05 for tick in run.trace)
    assert backward == bool(seen)


def test_a_drive_is_as_it_was_decided_although_the_robot_has_rolled_on_since(kitchen):
    """Decided 1.004 m from a subgoal, a bend was driven straight: from where the robot began it was less than 1 m."""
    controller = kitchen.actions["goToPose"].controller
    arguments = np.array([0.65, 0.49, 0.98, 0.07, 1.37, 1.19, 0.0, 0.31, 1.0])
    for x, y in ((0.65, 0.49), (0.67, 0.52)):
        belief = replace(kitchen.initial_belief(), pose=Pose(x, y, 0.98, (1e-8, 0.0, 0.0, 1e-8, 0.0, 1e-8)))
        assert isinstance(controller(None, 0, belief, arguments).state, Far)
