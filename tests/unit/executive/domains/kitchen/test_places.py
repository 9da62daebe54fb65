"""Places of the kitchen: ranges of stands and spots, abstract state and plans."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from tailor.executive import domains, planning
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.kitchen import abstract_state, objects, places, predicates, robot
from tailor.executive.domains.kitchen.belief import KitchenBelief
from tailor.executive.domains.kitchen.objects import Thing
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.domain import Conflict, LabelQuery
from tailor.executive.refinement.instantiation import instantiate
from tailor.schemas.kitchen.furniture import kitchen, on_table

EXACT = (1e-8, 0.0, 0.0, 1e-8, 0.0, 1e-8)
CUP_M = kitchen().table.size[2] + kitchen().cup.height / 2
TABLE1 = (-2.35, 0.0, 0.1)


def scenario(name="one-cup", seed=3):
    return domains.seeded_scenario("kitchen", name, seed)[0]


def cup(x, y, z=CUP_M, tilt=0.0, name="cup1"):
    return Thing(name, x, y, z, math.pi, tilt, 1e-6, 1)


def believed(*things, pose=(0.0, 0.6, 0.0), **fields):
    table = Thing("table1", *TABLE1[:2], 0.72, TABLE1[2], 0.0, 1e-6, 1)
    return KitchenBelief(pose=Pose(*pose, EXACT), things=(table, *things), poses_seen=9, joints_ns=1, **fields)


def on_table1(x=0.23, y=0.2):
    return on_table(TABLE1, x, y)[:2]


def query(quantity, label, belief, holds=(), achieved=(), name="one-cup"):
    return predicates.value(LabelQuery(quantity, label, holds, achieved, belief, scenario(name)))


@pytest.mark.parametrize("corner", range(4))
@pytest.mark.parametrize("turned", [-0.12, 0.0, 0.12])
@pytest.mark.parametrize("table", sorted(kitchen().tables))
def test_every_stand_is_at_the_distance_of_the_precondition(table, turned, corner):
    x, y, phi = kitchen().tables[table]
    place = (x, y, phi + turned)
    spot = places.Spot(place, *on_table(place, 0.23, 0.2)[:2])
    ranges = places.stand_ranges(spot)
    at = (ranges["x"], ranges["y"])
    stand = [r.upper if corner >> k & 1 else r.lower for k, r in enumerate(at)]
    c, s = math.cos(place[2]), math.sin(place[2])
    distance = c * (stand[0] - x) + s * (stand[1] - y) - kitchen().edge_m
    assert places.TABLE_M[0] - 0.005 <= distance <= places.TABLE_M[1] + 0.005


def test_the_stand_follows_the_cup_that_was_seen():
    before = query("y", "table1", believed(cup(*on_table1())), (("cup-at", "cup1", "table1"),))
    after = query("y", "table1", believed(cup(*on_table1(y=0.1))), (("cup-at", "cup1", "table1"),))
    assert before.lower - after.lower == pytest.approx(0.1, abs=0.01)


def test_where_a_cup_may_be_put_is_free():
    spot = query("spot_y", "table2", believed(), (("free", "table2"),), (("robot-at", "table2"),))
    assert spot.upper - spot.lower > 0.05


def planned(domain, task, goal=""):
    pddl = planning.parse_domain(domain.pddl)
    problem = planning.parse_problem(task.problem, pddl)
    search = planning.Search(pddl, problem.with_goal(goal) if goal else problem, planning.DEFAULT)
    return search.advance(CheckBudget(100_000)).plan


def test_one_cup_leaves_ten_parameters_free():
    task, domain = scenario(), domains.load("kitchen")
    plan = planned(domain, task)
    assert [step.action[0] for step in plan.steps] == ["navigate", "grip", "navigate", "put"]
    sequence = instantiate(plan, domain, believed(cup(*on_table1())), task)
    assert len(sequence.free()) == 10


def test_two_cups_take_thirteen_actions():
    assert len(planned(domains.load("kitchen"), scenario("two-cups")).steps) == 13


@pytest.mark.parametrize("goal", ["(arm-out)", "(open dock)"])
def test_a_goal_for_the_arm_at_a_place_without_a_spot_fails_and_says_why(goal):
    """It ended the executive."""
    task, domain = scenario(), domains.load("kitchen")
    failure = instantiate(planned(domain, task, goal), domain, believed(), task)
    assert failure.reason == "reach dock: dock has no spot for a cup"


def test_nobody_knows_where_a_robot_started_that_has_left_there():
    """A goal to go back there ended the executive, with a KeyError."""
    with pytest.raises(Conflict, match="dock has no stand"):
        query("x", "dock", believed(), achieved=(("robot-at", "dock"),))


REMEMBERED = frozenset({("robot-at", "table1"), ("cup-at", "cup1", "table1"), ("hand-empty",), ("arm-home",)})
STAND = (-1.4, 0.2, math.pi)


def anchored(belief):
    return abstract_state.anchor(belief, scenario(), REMEMBERED)


def test_a_cup_in_its_place_is_there():
    facts = anchored(believed(cup(*on_table1()), pose=STAND))
    assert {("cup-at", "cup1", "table1"), ("robot-at", "table1"), ("hand-empty",), ("free", "table2")} <= facts
    assert ("free", "table1") not in facts


@pytest.mark.parametrize("lost", [{"z": 0.05}, {"tilt": 1.5}])
def test_a_cup_on_the_floor_or_tipped_is_nowhere(lost):
    facts = anchored(believed(cup(*on_table1(), **lost), pose=STAND))
    assert not any(fact[0] in ("cup-at", "holding") for fact in facts)


@pytest.mark.parametrize(
    ("other", "tilt", "y", "free"), [("cup2", 0.0, 0.2, False), ("cup1", 1.5, 0.2, False), ("cup2", 0.0, 0.0, True)]
)
def test_no_cup_is_put_on_one_that_is_none_of_the_task_or_has_tipped(other, tilt, y, free):
    """It knocked it over."""
    there = cup(*on_table(kitchen().tables["table2"], 0.23, y)[:2], tilt=tilt, name=other)
    assert (("free", "table2") in anchored(believed(there, pose=STAND))) is free


@pytest.mark.parametrize(("moved", "spots"), [((0.12, 0.12, 0.12), (0, 1)), ((-0.12, -0.22, -0.12), (0, 1))])
def test_cups_on_a_table_that_is_not_seen_yet_are_where_the_map_has_them(moved, spots):
    """Not beside its outline on the map, at no place, nor both at one place: the task was given up as unsolvable."""
    x, y, phi = kitchen().tables["table1"]
    table = (x + moved[0], y + moved[1], phi + moved[2])
    cups = [cup(*on_table(table, *kitchen().table.slots[k])[:2], name=f"cup{k + 1}") for k in spots]
    belief = KitchenBelief(pose=Pose(0.0, 0.6, 0.0, EXACT), things=tuple(cups), poses_seen=9, joints_ns=1)
    facts = abstract_state.anchor(belief, scenario("two-cups"), frozenset())
    assert {("cup-at", "cup1", "left1"), ("cup-at", "cup2", "right1")} <= facts


def test_a_cup_elsewhere_is_on_no_table_whether_that_is_seen_or_not():
    beside = cup(*on_table(kitchen().tables["table1"], 0.56, 0.2)[:2])
    unseen = KitchenBelief(pose=Pose(0.0, 0.6, 0.0, EXACT), things=(beside,), poses_seen=9, joints_ns=1)
    off = cup(*on_table1(x=0.36))
    for belief in (unseen, believed(off)):
        assert not any(fact[0] == "cup-at" for fact in anchored(belief))


def test_a_cup_that_stands_at_another_table_is_there_although_that_is_not_seen():
    moved = cup(*on_table(kitchen().tables["table2"], 0.3, 0.25)[:2])
    assert ("cup-at", "cup1", "table2") in anchored(believed(moved))


def test_a_cup_lost_on_the_way_is_looked_for_where_the_map_has_it():
    lost = KitchenBelief(pose=Pose(0.0, 0.0, 0.0, EXACT), poses_seen=9, joints_ns=1)
    facts = abstract_state.anchor(lost, scenario(), frozenset({("robot-at", "dock"), ("holding", "cup1")}))
    assert {("cup-at", "cup1", "table1"), ("hand-empty",)} <= facts


@pytest.mark.parametrize(("z", "kept"), [(CUP_M, True), (1.05, False)])
def test_a_cup_that_left_the_gripper_is_known_only_if_it_was_put_down(z, kept):
    assert bool(objects.let_go((cup(*on_table1(), z=z),), "cup1")) is kept


def test_a_cup_out_of_reach_makes_the_robot_drive_again():
    assert ("robot-at", "dock") in anchored(believed(cup(*on_table1(y=-0.15)), pose=STAND))


def test_a_cup_in_the_gripper_is_held():
    facts = anchored(believed(cup(*on_table1()), pose=STAND, held="cup1"))
    assert ("holding", "cup1") in facts
    assert ("hand-empty",) not in facts


def test_a_hand_with_a_cup_that_is_none_of_the_task_is_not_empty():
    """The robot dropped it to grip the other one."""
    facts = anchored(believed(cup(*on_table1()), pose=STAND, held="cup2"))
    assert not facts & {("hand-empty",), ("holding", "cup2")}


def test_a_robot_with_its_arm_out_may_not_drive():
    out = replace(believed(cup(*on_table1()), pose=STAND), angles=(0.0,) * len(robot.HOME))
    assert ("arm-home",) not in anchored(out)


def test_scenarios_differ_with_the_seed():
    starts = [domains.load_scenario("kitchen", "one-cup", np.random.default_rng(seed))[1] for seed in (1, 2, 1)]
    assert starts[0] != starts[1]
    assert starts[0] == starts[2]


def test_an_arm_that_is_out_points_where_it_points():
    """Aside of the line from shoulder to cup: it would have to swing to point elsewhere, as no model knows."""
    x, y = on_table1()
    standing = believed(cup(x, y), pose=(-1.4, y, math.pi))
    ahead, left = standing.in_base(x, y)
    reached = replace(standing, angles=robot.angles_for(robot.level_hand(ahead, left, robot.GRASP_M + 0.07, 0.2, 0.12)))
    here = (("robot-at", "table1"), ("cup-at", "cup1", "table1"))
    assert query("aside", "table1", standing, here) is None
    bound = query("aside", "table1", reached, here)
    assert bound.lower == bound.upper == pytest.approx(0.2, abs=0.01)
    assert query("aside", "table2", reached, (("free", "table2"),)) is None
