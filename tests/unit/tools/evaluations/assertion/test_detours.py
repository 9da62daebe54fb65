"""Ways around what stands there by hand-made geometry: objects, legs, graphs, controllers."""

import itertools
import math

import numpy as np
import pytest

from tailor.executive import domains
from tailor.executive.actions.arrival_path import ArrivalPath
from tailor.executive.belief.angles import difference
from tailor.executive.domains.soccer import robot
from tailor.executive.interfaces.action_context import ActionContext, ContextColumn
from tailor.tools.evaluations.detours.geometry import GEOMETRIES, objects_of
from tailor.tools.evaluations.detours.graph import DetourGraph
from tailor.tools.evaluations.detours.legs import Legs, legs_of

SOCCER, KITCHEN = GEOMETRIES["soccer"], GEOMETRIES["kitchen"]
BENDS = Legs(ArrivalPath(robot.V_MAX_MPS), lambda start, goal: None)
START, GOAL = (-1.5, 0.0, 0.0), (1.5, 0.0, 0.0)
FIELD = (3.5, 2.25)
CUPBOARD = (2.2, 1.1)


def beside(*discs):
    objects = np.array([(x, y, 0.0, 0.0, 0.0, radius, np.inf) for x, y, radius in discs]).reshape(-1, 7)
    return DetourGraph(BENDS, SOCCER, objects, FIELD, SOCCER.margins_m[0])


def around(*discs):
    return beside(*discs).quickest(START, [GOAL], 0.0)


def test_a_free_way_has_no_poses_but_the_goal():
    assert around() == (GOAL,)
    assert around((0.0, 1.0, 0.2)) == (GOAL,)


@pytest.mark.parametrize("discs", [[(0.0, 0.0, 0.2)], [(0.0, 0.1, 0.2), (0.2, -0.6, 0.25), (-0.3, 0.8, 0.15)]])
def test_the_poses_lead_past_every_disc(discs):
    *poses, goal = around(*discs)
    assert poses
    assert goal == GOAL
    for a, b in itertools.pairwise([START, *poses, GOAL]):
        way = BENDS.between(a, b, 0.5 if b in poses else 0.0).poses
        assert all(np.hypot(way[:, 0] - x, way[:, 1] - y).min() > radius + 0.27 for x, y, radius in discs)


def test_it_takes_the_shorter_side():
    (_, y, _), _ = around((0.0, 0.15, 0.2))
    assert y < 0


def test_a_goal_inside_a_ring_of_discs_has_no_way():
    ring = [(1.5 + 0.6 * math.cos(k), 0.6 * math.sin(k), 0.25) for k in np.arange(0, math.tau, 0.5)]
    assert around(*ring) is None


def test_between_two_walls_two_poses_are_needed():
    walls = [(-0.4, y, 0.2) for y in (-0.9, -0.5, -0.1, 0.3)] + [(0.6, y, 0.2) for y in (-0.3, 0.1, 0.5, 0.9)]
    assert len(around(*walls)) == 3


def test_what_takes_less_turning_is_quicker():
    legs = legs_of(domains.load("kitchen").actions["goToPose"].controller, seen=False)
    graph = DetourGraph(legs, KITCHEN, np.zeros((0, 7)), FIELD, KITCHEN.margins_m[0])
    ahead, about = (0.8, 0.0, 0.0), (0.8, 0.0, -math.pi)
    assert graph.quickest((0.0, 0.0, 0.0), [about, ahead], 0.0) == (ahead,)


def kitchen_objects():
    domain = domains.load("kitchen")
    return objects_of(domain.actions["goToPose"].context, domain.initial_belief())


def test_the_kitchens_geometry_knows_all_that_stands_there():
    objects = kitchen_objects()
    round_ones = objects[(objects[:, 3:5] == 0.0).all(1)]
    assert round_ones == pytest.approx(np.array([(1.3, 0.55, 0.0, 0.0, 0.0, 0.27, 0.45)]), abs=1e-6)
    assert len(objects) == 11, "stool, three tables, counter, fridge, cupboard, four walls"


def test_opponents_are_cylinders_over_which_nothing_passes():
    columns = domains.load("soccer").actions["goToPose"].context.columns
    columns = (*columns, ContextColumn("opponent_speed", "m/s", 0.0, 1.0))  # of which this knows nothing
    (row,) = objects_of(ActionContext(columns, lambda _: np.array([[1.0, 2.0, 0.2, 0.7]]), "", ""), None)
    assert row.tolist() == [1.0, 2.0, 0.0, 0.0, 0.0, 0.2, math.inf]


@pytest.mark.parametrize(
    ("pose", "gap_m", "low_gap_m"),
    [
        ((0.0, 0.0, 0.0), 0.7 - 0.535 - 0.075, 0.7 - 0.265),  # the hand is nearest, if it does not pass over
        ((0.0, 0.0, math.pi), 0.7 - 0.265, 0.7 - 0.265),  # now it is behind
        ((1.2, -2.0, 0.0), 1.5 - 0.265, 1.5 - 0.265),
        ((2.0, 0.8, 0.0), 0.3 * 2**0.5 - 0.265, 0.3 * 2**0.5 - 0.265),  # from a corner
    ],
)
def test_a_gap_is_that_of_the_nearest_part(pose, gap_m, low_gap_m):
    box = np.array([(1.2, 0.0, math.pi / 2, 0.5, 0.5, 0.0, 2.0)])
    poses = np.array([pose, (-9.0, -9.0, 0.0)])
    assert KITCHEN.gap_m(poses, box) == pytest.approx(gap_m)
    box[0, -1] = 0.7
    assert KITCHEN.gap_m(poses, box) == pytest.approx(low_gap_m)


@pytest.mark.parametrize(
    ("goal", "seen", "straight"),
    [
        ((-0.8, 0.0, 0.0), False, True),  # near: it backs off
        ((-1.5, 0.0, 0.0), True, True),
        ((0.8, 0.0, 0.0), False, True),
        ((-1.5, 0.0, 0.0), False, False),  # it sees ahead only, so it bends into what is far
        ((1.5, 0.5, 1.0), True, False),
    ],
)
def test_legs_are_what_the_kitchens_controller_drives(goal, seen, straight):
    leg = legs_of(domains.load("kitchen").actions["goToPose"].controller, seen).between((0.0, 0.0, 0.0), goal, 0.0)
    assert leg.poses[[0, -1], :2] == pytest.approx(np.array([(0.0, 0.0), goal[:2]]))
    turned = max(abs(difference(phi, 0.0)) for phi in leg.poses[:, 2])
    assert (turned < 1e-6) == straight
    assert leg.length_m >= math.dist((0.0, 0.0), goal[:2]) - 1e-9


def test_a_straight_leg_turns_on_the_spot_at_both_ends():
    legs = legs_of(domains.load("kitchen").actions["goToPose"].controller, seen=False)
    leg = legs.between((0.0, 0.0, 0.0), (0.0, 0.8, 0.0), 0.0)
    assert leg.turned_rad == pytest.approx(math.pi)
    at_start, at_end = ((np.hypot(*(leg.poses[:, :2] - end).T) < 1e-9).sum() for end in ((0.0, 0.0), (0.0, 0.8)))
    assert at_start > 10
    assert at_end > 10


def test_of_free_headings_one_is_taken_at_which_the_hand_touches_nothing():
    legs, objects = legs_of(domains.load("kitchen").actions["goToPose"].controller, seen=False), kitchen_objects()
    graph = DetourGraph(legs, KITCHEN, objects, (3.0, 2.25), KITCHEN.margins_m[0])
    start, towards = (2.2, 0.6, -math.pi / 2), (*CUPBOARD, math.pi / 2)
    assert graph.quickest(start, [towards], 0.0) is None, "the hand would be in the cupboard"
    aside = (*CUPBOARD, math.pi)
    assert graph.quickest(start, [towards, aside], 0.0)[-1] == aside
