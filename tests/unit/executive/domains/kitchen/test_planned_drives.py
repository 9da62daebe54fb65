"""Drives to far goals, simulated, stay near the ways from which the clearances of objects are taken."""

import numpy as np
import pytest

pytest.importorskip("pybullet")

from tailor.models.features.drive_clearance.poses import drive
from tailor.models.features.features import NUMPY
from tailor.models.features.kitchen.spaces import B21
from tailor.tools.lockstep import action_run

NEAR_GOAL_M = 0.3  # there the bend ends with the controller's own corrections
FARTHEST_M = 0.06
DRIVES = (  # towards subgoals beside the stool, of which runs grazed it: they left their planned ways by 9 cm
    (0.508, 0.657, -0.389, 0.0, 1.4, 1.112, 0.09, 0.35, 1.0),
    (0.346, 0.376, 0.636, 0.0, 1.394, 0.225, 0.285, 0.337, 1.0),
)


def planned(arguments):
    """Places on the planned way, shape (n, 2)."""
    rows = np.array([arguments], np.float32).T
    way = drive(B21, rows[[0, 1, 2, 4, 5, 6]], rows[[3]], (np.cos(rows[[6]]), np.sin(rows[[6]])), rows[[8]], NUMPY)
    parts = (way.turning.x, way.turning.y), way.straight, (way.arriving.x, way.arriving.y)
    return np.concatenate([np.hstack(part) for part in parts])


def distance(way, place):
    """From a place to the polyline of a way, m."""
    start, along = way[:-1], np.diff(way, axis=0)
    share = ((place - start) * along).sum(1) / np.maximum((along**2).sum(1), 1e-12)
    return np.hypot(*(start + np.clip(share, 0.0, 1.0)[:, None] * along - place).T).min()


@pytest.mark.parametrize("arguments", DRIVES)
def test_a_drive_that_turns_a_little_keeps_near_its_planned_way(body, kitchen, arguments):
    run = action_run.run_action(body, kitchen, "goToPose", np.array(arguments), np.random.default_rng(0), traced=True)
    places = np.array([(tick.truth.x, tick.truth.y) for tick in run.trace])
    on_way = places[np.hypot(*(places - arguments[4:6]).T) > NEAR_GOAL_M]
    assert max(distance(planned(arguments), place) for place in on_way) < FARTHEST_M
