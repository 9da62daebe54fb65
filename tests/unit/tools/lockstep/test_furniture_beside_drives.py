"""Furniture noted after drives of the kitchen robot: what it would have touched, and nothing else."""

import math

import numpy as np
import pytest

pytest.importorskip("pybullet")

from tailor.executive import domains
from tailor.executive.domains.kitchen.drive_context import FURNITURE, TOUCHED, may_meet
from tailor.executive.interfaces.outlet import at_rest, completed
from tailor.schemas.errors import UsageError
from tailor.schemas.kitchen.kinematics import BASE_RADIUS_M, HOME, tool_pose
from tailor.schemas.messages.kitchen import KitchenTruth
from tailor.tools.learning.gathering.beside_objects import runs_beside_objects
from tailor.tools.lockstep.action_run import new_body
from tailor.tools.lockstep.samplers.free_drives import X_M, Y_M, free_drive
from tailor.tools.lockstep.samplers.outlines import HAND_M, clearances
from tailor.tools.lockstep.task_sampler import sampler_of

DOMAIN = domains.load("kitchen")
ACTION = DOMAIN.actions["goToPose"]
FRIDGE = (1.1, 1.95, 0.0, 0.3, 0.3, 0.0, 1.7)
GRAZED_M = 0.01


@pytest.fixture(scope="module")
def body():
    return new_body(DOMAIN)


def turned_beside_fridge(body, y, phi):
    """Whether the hand touches the fridge in the simulation as the robot turns left by a right angle; its poses."""
    body.reset(np.random.default_rng(0), {"x": 1.1, "y": y, "phi": phi, "stool_x": 2.75, "stool_y": -1.95})
    touched, poses = set(), []
    for _ in range(25):
        body.command(completed(DOMAIN, ACTION, (0.0, 0.8), at_rest(DOMAIN.axes)))
        for reading in body.advance(10**8):
            if isinstance(reading.message, KitchenTruth):
                touched |= set(reading.message.touched)
                poses.append((reading.message.x, reading.message.y, reading.message.phi))
        if touched:
            break
    return touched, np.array(poses)


@pytest.mark.parametrize(("y", "phi"), [(1.2, 0.0), (1.12, 0.3), (1.0, 0.0), (1.2, 2.3), (1.3, 2.6)])
def test_the_hand_touches_the_fridge_where_its_outline_does(body, y, phi):
    touched, poses = turned_beside_fridge(body, y, phi)
    clear_m = clearances(poses, np.array(FRIDGE)).min()
    if abs(clear_m) > GRAZED_M:
        assert bool(touched) is bool(clear_m < 0), clear_m
    else:
        assert touched <= {"fridge"}


def test_the_outline_holds_the_folded_hand():
    assert HAND_M[-1][1] == pytest.approx(tool_pose(HOME).x + 0.03, abs=2e-3), "fingers end 3 cm beyond the grasp point"


@pytest.mark.parametrize(
    ("row", "clear_m"),
    [
        ((1.0, 0.0, 0.0, 0.0, 0.0, 0.2, 0.45), 0.8 - BASE_RADIUS_M),
        ((1.0, 0.0, 0.5, 0.0, 0.0, 0.2, 0.45), 0.8 - BASE_RADIUS_M),
        ((1.0, 0.0, math.pi / 2, 0.9, 0.3, 0.0, 0.72), 0.7 - BASE_RADIUS_M),
        ((1.0, 0.0, math.pi / 2, 0.9, 0.3, 0.0, 1.70), 0.7 - 0.61),
        ((0.0, 1.0, 0.0, 0.9, 0.3, 0.0, 1.70), 0.7 - BASE_RADIUS_M),
        ((0.1, 0.0, 0.0, 0.3, 0.3, 0.0, 0.72), -0.2 - BASE_RADIUS_M),
    ],
)
def test_distances_are_those_of_base_and_hand(row, clear_m):
    assert clearances(np.zeros((1, 3)), np.array(row))[0] == pytest.approx(clear_m, abs=1e-9)


def test_one_drive_gives_many_episodes_with_stools_low_and_tall_boxes(body):
    episodes, _ = runs_beside_objects(30, DOMAIN, "goToPose", body, range(3), lambda k: np.random.default_rng([3, k]))
    rows = np.array([episode.arguments[9:] for episode in episodes])
    stool, tall = rows[:, 5] > 0, rows[:, 6] > 1.0
    assert all(kind.sum() > 5 for kind in (stool, tall, ~stool & ~tall))
    assert (rows[stool][:, [3, 4]] == 0).all()
    assert {episode.failure for episode in episodes} == {"", TOUCHED}


def test_the_planned_ways_of_free_drives_stay_in_the_open():
    rng = np.random.default_rng(0)
    drives = np.array([free_drive(ACTION.controller, rng) for _ in range(50)])
    for k, (low, high) in ((0, X_M), (1, Y_M), (4, X_M), (5, Y_M)):
        assert ((low - 0.1 < drives[:, k]) & (drives[:, k] < high + 0.1)).all()


def test_what_a_drive_meets_may_be_met_and_what_is_far_may_not(body):
    episodes, _ = runs_beside_objects(40, DOMAIN, "goToPose", body, range(5), lambda k: np.random.default_rng([4, k]))
    touched = [e.arguments for e in episodes if e.failure]
    assert len(touched) > 20
    assert all(may_meet(each[None, :9], each[None, 9:]).item() for each in touched)
    drive = np.array([[0.0, 0.0, 0.0, 0.0, 0.8, 0.0, 0.0, 0.0, 1.0]])
    low, tall = np.array([[0.4, 0.85, 0.0, 0.3, 0.3, 0.0, 0.7], [0.4, 0.85, 0.0, 0.3, 0.3, 0.0, 1.7]])
    assert may_meet(drive, np.array([low, tall])).tolist() == [[False], [True]]


def test_only_a_stool_can_be_put_into_the_kitchen():
    sampler = sampler_of(DOMAIN)
    rng = np.random.default_rng(0)
    stool = np.array([0.5, 0.2, 0.0, 0.0, 0.0, 0.17, 0.45])
    assert sampler.context_start(ACTION, stool, rng) == {"stool_x": 0.5, "stool_y": 0.2}
    with pytest.raises(UsageError, match="--beside-objects"):
        sampler.context_start(ACTION, np.array(FRIDGE), rng)


def test_the_context_holds_stool_tables_furniture_and_walls():
    rows = np.array(FURNITURE.believed(DOMAIN.initial_belief()))
    assert rows.shape == (11, 7)
    assert (rows[:, 6] > 1.03).sum() == 2, "fridge and cupboard"
    assert tuple(rows[rows[:, 5] > 0][0]) == pytest.approx((1.3, 0.55, 0.0, 0.0, 0.0, 0.27, 0.45)), "unseen: wider"
