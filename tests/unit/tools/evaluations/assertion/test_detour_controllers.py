"""Controllers that drive detours: when they plan anew, when they turn first, which heading they take."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tailor.executive import domains
from tailor.executive.actions.arrival_path import ArrivalPath
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.soccer import robot
from tailor.executive.interfaces.action import Control
from tailor.executive.interfaces.action_context import ActionContext
from tailor.schemas.messages.soccer import OpponentsTruth
from tailor.tools.evaluations.detours.controller import DetourController, with_detours
from tailor.tools.evaluations.detours.geometry import GEOMETRIES
from tailor.tools.evaluations.detours.legs import Legs
from tailor.tools.lockstep.action_run import new_body
from tailor.tools.lockstep.readings import newest

SOCCER = GEOMETRIES["soccer"]
BENDS = Legs(ArrivalPath(robot.V_MAX_MPS), lambda start, goal: None)
START, GOAL = (-1.5, 0.0, 0.0), (1.5, 0.0, 0.0)
ARGUMENTS = np.array([*START, 0.0, *GOAL, 0.0])
FIELD = (3.5, 2.25)
CUPBOARD = (2.2, 1.1)
IN_THE_WAY, ELSEWHERE = (0.0, 0.1, 0.2), (0.0, 1.9, 0.2)
COLUMNS = domains.load("soccer").actions["goToPose"].context.columns


def believed(*pose):
    return replace(domains.load("soccer").initial_belief(), pose=Pose(*pose, (1e-4, 0.0, 0.0, 1e-4, 0.0, 1e-4)))


def detours(*opponents, go=lambda *_: Control(None, (0.5, 1.0)), legs=(BENDS, BENDS), geometry=SOCCER, **more):
    context = ActionContext(COLUMNS, lambda _: np.array(opponents).reshape(-1, 3), "", "")
    return DetourController(go, go, legs, geometry, context, FIELD, **more)


@pytest.mark.parametrize("detours_on", [False, True])
def test_controllers_with_detours_touch_no_opponent_in_the_way(detours_on):
    domain = domains.load("soccer")
    domain = with_detours(domain, "soccer", "opponents") if detours_on else domain
    body, belief, state, touched = new_body(domain), domain.initial_belief(), None, False
    body.reset(np.random.default_rng(1), {"x": -1.5, "opponent1_x": 0.0, "opponent1_y": 0.05, "opponent1_radius": 0.2})
    control = None
    for tick in range(1, 200):
        readings = body.advance(10**8)
        touched |= any(r.message.touched for r in readings if isinstance(r.message, OpponentsTruth))
        belief = domain.update(belief, tick * 10**8, newest(readings), (0.0, 0.0))
        if tick > 15:
            arguments = np.array([-1.5, 0, 0, 0, *GOAL, 0.0])
            control = domain.actions["goToPose"].controller(state, tick * 10**8, belief, arguments)
            state = control.state
            if control.outcome != "running":
                break
            body.command(control.command)
    assert touched is not detours_on
    if detours_on:
        assert control.outcome == "done"
        assert math.dist((body.ground_truth().x, body.ground_truth().y), GOAL[:2]) < 0.2


@pytest.mark.parametrize("opponents", [(), ((0.5, 0.0, 0.2),)])
def test_a_leg_begins_where_the_robot_is(opponents):
    """Controllers may decide by the start in their arguments; that of the action is long passed."""
    given = []

    def go(state, now_ns, belief, arguments):
        given.append(arguments[:3].tolist())
        return Control(state, (0.0, 0.0))

    detours(*opponents, go=go)(None, 0, believed(-0.7, 0.1, 0.2), ARGUMENTS)
    assert given == [[-0.7, 0.1, 0.2]]


def test_it_plans_anew_when_something_moves_into_its_way():
    state = detours(ELSEWHERE)(None, 0, believed(*START), ARGUMENTS).state
    assert state.poses == (GOAL,)
    state = detours(IN_THE_WAY)(state, 0, believed(*START), ARGUMENTS).state
    assert len(state.poses) > 1


def test_a_way_that_stays_clear_is_kept():
    state = detours(IN_THE_WAY)(None, 0, believed(*START), ARGUMENTS).state
    assert detours(ELSEWHERE)(state, 0, believed(*START), ARGUMENTS).state.poses == state.poses


def test_a_smaller_margin_is_taken_where_a_wider_one_leaves_no_way():
    wide, both = (replace(SOCCER, margins_m=margins) for margins in ((2.0,), (2.0, 0.1)))
    assert detours(IN_THE_WAY, geometry=wide)(None, 0, believed(*START), ARGUMENTS).state.poses == (GOAL,)
    assert len(detours(IN_THE_WAY, geometry=both)(None, 0, believed(*START), ARGUMENTS).state.poses) > 1


@pytest.mark.parametrize("seen", [0, 1])
def test_its_legs_are_those_of_what_the_robot_has_seen(seen):
    used = []
    legs = tuple(Legs(BENDS.ways, lambda start, goal, name=name: used.append(name)) for name in (0, 1))
    detours(ELSEWHERE, legs=legs, seen=8)(None, 0, believed(*START), np.append(ARGUMENTS, float(seen)))
    assert set(used) == {seen}


@pytest.mark.parametrize(
    ("opponent", "leg", "command"),
    [
        ((-1.5, 0.7, 0.2), None, (0.0, 1.0)),
        ((-1.5, 0.9, 0.2), None, (0.5, 1.0)),  # too far away to matter
        ((-1.5, 0.7, 0.2), "on its way", (0.5, 1.0)),
    ],
)
def test_beside_something_it_turns_before_it_drives(opponent, leg, command):
    detour = detours(opponent, go=lambda *_: Control(leg, (0.5, 1.0)))
    assert detour(None, 0, believed(*START), ARGUMENTS).command == command


@pytest.mark.parametrize(("scenario", "kept"), [("to-cupboard", False), ("one-cup", True)])
def test_a_heading_is_chosen_where_the_scenario_leaves_it_open(scenario, kept):
    kitchen = with_detours(domains.load("kitchen"), "kitchen", scenario)
    belief = replace(kitchen.initial_belief(), pose=Pose(2.2, 0.6, -math.pi / 2, (1e-4, 0.0, 0.0, 1e-4, 0.0, 1e-4)))
    arguments = np.array([2.2, 0.6, -math.pi / 2, 0.0, *CUPBOARD, math.pi / 2, 0.0, 0.0])
    poses = kitchen.actions["goToPose"].controller(None, 0, belief, arguments).state.poses
    assert (poses[-1][2] == math.pi / 2) == kept
