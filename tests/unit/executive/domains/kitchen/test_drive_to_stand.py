"""Drives to near stands: no loops before the table, no contact, at rest where they should be."""

import math

import numpy as np
import pytest

pytest.importorskip("pybullet")

from tailor.executive import domains
from tailor.executive.belief.angles import difference
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


@pytest.fixture(scope="module")
def kitchen():
    return domains.load("kitchen")


@pytest.fixture(scope="module")
def body(kitchen):
    return action_run.new_body(kitchen)


@pytest.mark.parametrize(("start", "goal"), NEAR)
def test_a_drive_to_a_near_stand_touches_nothing_and_makes_no_loop(body, kitchen, start, goal):
    arguments = np.array([*start, 0.0, *goal, 0.0])
    run = action_run.run_action(body, kitchen, "goToPose", arguments, np.random.default_rng(0), traced=True)
    end = run.trace[-1].truth
    assert run.failure == ""
    assert run.duration_s < 6.0
    assert math.dist((end.x, end.y), goal[:2]) < 0.05
    assert abs(difference(end.phi, goal[2])) < 0.15
    assert max(math.dist((tick.truth.x, tick.truth.y), start[:2]) for tick in run.trace) < 1.3 * math.dist(
        start[:2], goal[:2]
    )
