"""Clearances of planned drives: the planners' own ways, distances from boxes and cylinders, what they ignore."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tailor.executive import domains
from tailor.models.features.drive_clearance import way as way_module
from tailor.models.features.drive_clearance.beside_box import beside_box
from tailor.models.features.drive_clearance.poses import drive
from tailor.models.features.drive_clearance.way import cosines, is_near, planned
from tailor.models.features.features import NUMPY
from tailor.models.features.kitchen.spaces import B21, one_box
from tailor.models.features.straight_drive import straight_drive
from tailor.schemas.kitchen.kinematics import BASE_RADIUS_M

NAMES = [quantity.name for quantity in one_box.features]
FAR = 1.0  # m, clearances beyond are cut off
DRIVE = np.array([0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0])  # straight ahead
TALL, LOW = 1.8, 0.7


@pytest.fixture(scope="module")
def controller():
    return domains.load("kitchen").actions["goToPose"].controller


def poses(count: int):
    rng = np.random.default_rng(3)
    return rng.uniform([-2, -2, -math.pi, -2, -2, -math.pi], [2, 2, math.pi, 2, 2, math.pi], (count, 6))


def way_of(rows):
    columns = rows.T.astype(np.float32)
    goal = np.cos(columns[[5]]), np.sin(columns[[5]])
    return planned(B21, columns, goal, is_near(B21, columns, stool_seen(rows).T, NUMPY), NUMPY)


def stool_seen(rows):
    """Before every other drive, shape (n, 1)."""
    return np.arange(len(rows))[:, None] % 2


def drives_straight(controller, rows):
    """Whether the controller drives straight, of each row."""
    return [
        controller.side((x, y, phi), (xg, yg, phig), bool(stool)) is not None
        for (x, y, phi, xg, yg, phig), stool in zip(rows.tolist(), stool_seen(rows)[:, 0], strict=True)
    ]


def features(box, drive=DRIVE):
    return dict(zip(NAMES, one_box(np.array([[*drive, *box]]))[0].tolist(), strict=True))


def test_sines_and_cosines_are_exact_to_two_millionths() -> None:
    angles = np.linspace(-9.0, 9.0, 20001, dtype=np.float32)[None]
    for own, exact in zip(cosines(angles, NUMPY), (np.cos(angles), np.sin(angles)), strict=True):
        assert np.abs(own - exact).max() < 2e-6


def test_far_ways_are_those_that_the_controller_plans(controller) -> None:
    rows = poses(3000)
    way, straight_ways, compared = way_of(rows), drives_straight(controller, rows), 0
    for k, (x, y, phi, xg, yg, phig) in enumerate(rows.tolist()):
        if straight_ways[k]:
            continue
        c, s, compared = math.cos(phig), math.sin(phig), compared + 1
        start = (c * (x - xg) + s * (y - yg), c * (y - yg) - s * (x - xg), math.remainder(phi - phig, math.tau))
        path = controller.far.ways.quickest(start, 0.0)
        (_, straight), (_, bend), _ = path.pieces
        assert abs(math.remainder(path.start[2] + phig - way.facing[0, k].item(), math.tau)) < 1e-3
        assert way.straight[0, k] == pytest.approx(straight, abs=1e-3)
        assert way.bend[0, k] == pytest.approx(bend / path.radius, abs=5e-3)
        assert bend == 0 or way.radius[0, k] == pytest.approx(path.radius, abs=1e-3)
    assert compared > 2000


def test_near_ways_are_straight_and_backward_where_the_controller_backs_off(controller) -> None:
    rows = poses(4000)
    way = way_of(rows)
    backward, far = 0, 0
    for k in np.flatnonzero(drives_straight(controller, rows)):
        x, y, phi, xg, yg, phig = rows[k]
        distance = math.hypot(xg - x, yg - y)
        if distance < controller.there_m:
            continue
        side = controller.side((x, y, phi), (xg, yg, phig), bool(k % 2))
        far += distance > controller.near_m
        assert way.straight[0, k] == pytest.approx(side * distance, abs=1e-4)
        assert way.radius[0, k] == 0
        backward += side < 0
        assert distance < controller.near_m or (side < 0 and k % 2), "it bends into what is far ahead, or not known"
    assert backward > 50
    assert far > 50


def test_a_drive_ends_at_its_goal_or_a_run_in_before_it() -> None:
    rows = poses(2000)
    columns = rows.T.astype(np.float32)
    goal = np.cos(columns[[5]]), np.sin(columns[[5]])
    end = drive(B21, columns, np.zeros_like(columns[[0]]), goal, stool_seen(rows).T, NUMPY)
    x, y = end.arriving.x[-1] + goal[0][0] * end.way.run_in[0], end.arriving.y[-1] + goal[1][0] * end.way.run_in[0]
    assert np.abs(x - columns[3]).max() < 1e-5
    assert np.abs(y - columns[4]).max() < 1e-5


@pytest.mark.parametrize("phi", [0.0, math.pi, 1.0])
def test_a_cylinder_beside_a_straight_way_has_its_distance_from_the_base(phi) -> None:
    found = features((1.0, 0.7, phi, 0.0, 0.0, 0.2, LOW))
    assert found["clear_straight"] == pytest.approx(0.7 - 0.2 - BASE_RADIUS_M, abs=0.02)
    assert found["clear"] == pytest.approx(math.hypot(1.0, 0.7) - 0.2 - BASE_RADIUS_M, abs=1e-5)
    assert found["clear_g"] == pytest.approx(math.hypot(1.0, 0.7) - 0.2 - BASE_RADIUS_M, abs=1e-5)
    assert found["clear_turn"] == found["clear"]


def test_a_box_is_as_long_and_as_wide_as_it_is() -> None:
    beside = features((1.0, 0.6, 0.0, 0.3, 0.2, 0.0, LOW))
    assert beside["clear_straight"] == pytest.approx(0.4 - BASE_RADIUS_M, abs=1e-5)
    turned = features((1.0, 0.6, math.pi / 2, 0.2, 0.3, 0.0, LOW))
    assert turned == pytest.approx(beside, abs=1e-4)
    assert features((1.0, 0.1, 0.0, 0.3, 0.2, 0.0, LOW))["clear_straight"] < 0


def test_the_hand_reaches_over_what_is_low_and_into_what_is_tall() -> None:
    ahead = (2.8, 0.0, 0.0, 0.25, 0.25, 0.0)  # 0.55 m before the goal
    low, tall = features((*ahead, LOW)), features((*ahead, TALL))
    assert low["clear_g"] == tall["clear_g"] == pytest.approx(0.55 - BASE_RADIUS_M, abs=1e-5)
    assert low["hand_g"] == low["hand_bend"] == low["hand_turn"] == FAR
    assert tall["hand_g"] == pytest.approx(0.55 - 0.61, abs=1e-5)


def test_the_hand_sweeps_the_side_to_which_the_robot_turns() -> None:
    to_the_left = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.8, math.pi / 2, 0.0, 1.0])
    beside = {side: features((0.6, side * 0.45, 0.0, 0.15, 0.1, 0.0, TALL), to_the_left) for side in (1, -1)}
    assert beside[1]["hand_turn"] < 0.0 < beside[-1]["hand_turn"]


def test_moving_all_things_changes_no_feature() -> None:
    rng, rows = np.random.default_rng(4), poses(500)
    drives = np.column_stack([rows[:, :3], np.zeros(500), rows[:, 3:], np.zeros(500), stool_seen(rows)])
    boxes = rng.uniform([-2, -2, -0.7, 0, 0, 0, 0.4], [2, 2, 2.3, 1, 0.5, 0.2, 2], (500, 7))
    turn, c, s = 0.8, math.cos(0.8), math.sin(0.8)
    moved, boxes_moved = drives.copy(), boxes.copy()
    for table, x in ((drives, 0), (drives, 4), (boxes, 0)):
        into = boxes_moved if table is boxes else moved
        into[:, x], into[:, x + 1] = 1 + c * table[:, x] - s * table[:, x + 1], s * table[:, x] + c * table[:, x + 1]
        into[:, x + 2] = table[:, x + 2] + turn
    before, after = one_box(np.hstack([drives, boxes])), one_box(np.hstack([moved, boxes_moved]))
    off = np.abs(before - after).max(axis=1)
    assert (off < 1e-3).mean() > 0.99, "but for ways that are as quick as another one"


def test_ways_are_planned_with_the_numbers_of_the_controller(controller) -> None:
    ways = controller.far.ways
    assert (B21.v_max_mps, B21.bend_worth_radps) == (ways.v_max_mps, ways.bend_worth_radps)
    own = (controller.near_m, controller.there_m, controller.back_m, controller.back_rad)
    assert (B21.near_m, B21.there_m, B21.back_m, B21.back_rad) == own
    repeated = (way_module.RADIUS_M, way_module.INSIDE, way_module.TIGHTEST_M, way_module.RUN_IN_M)
    assert repeated == (ways.radius_m, ways.inside, ways.tightest_m, ways.run_in_m)
    chosen = (way_module.BESIDE_M, way_module.ASIDE_S_PER_M, 1 / way_module.FACING_S_PER_RAD)
    assert chosen == pytest.approx((ways.beside_m, ways.aside_s_per_m, ways.facing_radps))


def test_a_robot_of_another_size_has_other_clearances() -> None:
    wider = beside_box("wider", replace(B21, base_m=B21.base_m + 0.1))
    rows = np.array([[*DRIVE, 1.0, 0.7, 0.0, 0.0, 0.0, 0.2, LOW]])
    assert wider(rows)[0, NAMES.index("clear_straight")] == pytest.approx(
        one_box(rows)[0, NAMES.index("clear_straight")] - 0.1, abs=1e-6
    )


def test_a_turn_by_about_half_a_circle_may_go_to_either_side() -> None:
    behind = np.array([0.0, 0.0, 0.0, 0.0, -2.0, 0.05, math.pi, 0.0, 1.0])
    sides = [features((0.2, side * 0.75, 0.0, 0.0, 0.0, 0.17, LOW), behind)["clear_turn"] for side in (1, -1)]
    assert sides[0] == pytest.approx(sides[1], abs=0.05)
    assert max(sides) < features((0.2, 0.75, 0.0, 0.0, 0.0, 0.17, LOW), behind)["clear"] - 0.05


def test_a_drive_is_straight_where_the_controller_drives_straight(controller) -> None:
    rows = poses(4000)
    at_rest, stool = np.zeros(len(rows)), stool_seen(rows)
    drives = np.column_stack([rows[:, :3], at_rest, rows[:, 3:], at_rest, stool])
    straight = straight_drive(drives)[:, -1]
    assert (straight == is_near(B21, rows.T.astype(np.float32), stool.T, NUMPY)[0]).all()
    assert straight.tolist() == drives_straight(controller, rows)
    assert 200 < straight[0::2].sum() < straight[1::2].sum() - 50, "farther back where the stool has been seen"
