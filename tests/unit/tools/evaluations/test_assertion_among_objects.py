"""Detours by hand-made geometry, and the figures of `evaluate assertion`."""

import itertools
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
from tailor.tools.evaluations.assertion import assertion
from tailor.tools.evaluations.costs import Costs
from tailor.tools.evaluations.detour_controller import DetourController, discs_of, with_detours
from tailor.tools.evaluations.detour_graph import DetourGraph
from tailor.tools.evaluations.outcome import Outcome, Task
from tailor.tools.evaluations.task_runs import run_one
from tailor.tools.lockstep.action_run import new_body
from tailor.tools.lockstep.readings import newest

WAYS = ArrivalPath(robot.V_MAX_MPS)
START, GOAL = (-1.5, 0.0, 0.0), (1.5, 0.0, 0.0)
FIELD = (3.5, 2.25)


def around(*discs):
    return DetourGraph(WAYS, discs, FIELD).shortest(START, GOAL, 0.0)


def test_a_free_way_has_no_poses():
    assert around() == ()
    assert around((0.0, 1.0, 0.2)) == ()


@pytest.mark.parametrize("discs", [[(0.0, 0.0, 0.2)], [(0.0, 0.1, 0.2), (0.2, -0.6, 0.25), (-0.3, 0.8, 0.15)]])
def test_the_poses_lead_past_every_disc(discs):
    poses = around(*discs)
    assert poses
    graph = DetourGraph(WAYS, tuple(discs), FIELD)
    stops = [START, *poses, GOAL]
    assert all(graph.clear(a, b, 0.5 if b in poses else 0.0) for a, b in itertools.pairwise(stops))


def test_it_takes_the_shorter_side():
    ((_, y, _),) = around((0.0, 0.15, 0.2))
    assert y < 0


def test_a_goal_inside_a_ring_of_discs_has_no_way():
    ring = [(1.5 + 0.6 * math.cos(k), 0.6 * math.sin(k), 0.25) for k in np.arange(0, math.tau, 0.5)]
    assert around(*ring) is None


@pytest.mark.parametrize("detours", [False, True])
def test_controllers_with_detours_touch_no_opponent_in_the_way(detours):
    domain = domains.load("soccer")
    domain = with_detours(domain) if detours else domain
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
    assert touched is not detours
    if detours:
        assert control.outcome == "done"
        assert math.dist((body.ground_truth().x, body.ground_truth().y), GOAL[:2]) < 0.2


@pytest.mark.parametrize("opponents", [(), ((0.5, 0.0, 0.2),)])
def test_a_leg_begins_where_the_robot_is(opponents):
    """Controllers may decide by the start in their arguments; that of the action is long passed."""
    given = []

    def go(state, now_ns, belief, arguments):
        given.append(arguments[:3].tolist())
        return Control(state, (0.0, 0.0))

    domain = domains.load("soccer")
    context = ActionContext(
        domain.actions["goToPose"].context.columns, lambda _: np.array(opponents).reshape(-1, 3), "", ""
    )
    detour = DetourController(go, go, WAYS, context, FIELD)
    belief = replace(domain.initial_belief(), pose=Pose(-0.7, 0.1, 0.2, (1e-4, 0.0, 0.0, 1e-4, 0.0, 1e-4)))
    detour(None, 0, belief, np.array([*START, 0.0, *GOAL, 0.0]))
    assert given == [[-0.7, 0.1, 0.2]]


@pytest.mark.parametrize(("variant", "touched"), [(0, True), (1, False), (2, False)])
def test_subgoals_and_detours_lead_around_the_kitchens_stool(variant, touched):
    outcome = run_one(Task("kitchen", "to-cupboard"), assertion.variants()[variant], seed=700002)
    assert outcome.achieved
    assert (outcome.costs.contacts > 0) == touched


def test_the_hand_made_geometry_knows_cylinders_and_no_boxes():
    kitchen = domains.load("kitchen")
    context, belief = kitchen.actions["goToPose"].context, kitchen.initial_belief()
    assert len(context.believed(belief)) > 5
    (disc,) = discs_of(context, belief)
    assert disc == pytest.approx((1.3, 0.55, 0.27))
    columns = domains.load("soccer").actions["goToPose"].context.columns
    assert discs_of(ActionContext(columns, lambda _: np.array([[1.0, 2.0, 0.2]]), "", ""), belief) == ((1.0, 2.0, 0.2),)


NONE = Outcome(0, "", True, 5.0, "achieved", (), (), (), (), False, 0.0, (), ())


def outcome(seconds=5.0, contacts=0, asserted=False, achieved=True):
    return replace(NONE, duration_s=seconds, asserted=asserted, achieved=achieved, costs=Costs(contacts, 0.0, ()))


def test_a_row_counts_contacts_as_failures_and_needless_subgoals():
    found = {
        "before": {0: outcome(), 1: outcome(5.0), 2: outcome(contacts=1), 3: outcome(achieved=False)},
        "after": {0: outcome(), 1: outcome(5.5, asserted=True), 2: outcome(6.0, asserted=True), 3: outcome(contacts=2)},
        "baseline": {0: outcome(5.5), 1: outcome(5.5), 2: outcome(6.0), 3: outcome(7.0)},
    }
    row = assertion.row(found, range(4))
    assert (row["success_before_pct"], row["success_after_pct"], row["baseline_success_pct"]) == (50, 75, 100)
    assert row["needless_pct"] == 25
    assert math.isnan(row["needless_slower_pct"]), "one start has no mean"
    assert row["baseline_slower_pct"] == pytest.approx(10)
    assert row["after_slower_pct"] == pytest.approx(5)
    assert not assertion.reached(row)
    assert assertion.reached({"success_after_pct": 98.5, "needless_slower_pct": 7.0})
    assert not assertion.reached({"success_after_pct": 99.5, "needless_slower_pct": 9.0})


def test_what_a_few_needless_subgoals_cost_has_the_interval_of_a_few():
    before = {seed: outcome(10.0) for seed in range(3)}
    after = {seed: outcome(10.0 + seed, asserted=True) for seed in range(3)}
    row = assertion.row({"before": before, "after": after, "baseline": before}, range(3))
    assert row["needless_slower_pct"] == pytest.approx(10)
    assert row["ci95_needless_slower"] == pytest.approx((10 - 4.303 * 10 / 3**0.5, 10 + 4.303 * 10 / 3**0.5), abs=0.01)
    assert row["ci95_after_to_baseline"] == row["ci95_needless_slower"]


def test_what_caution_costs_counts_starts_without_a_subgoal_and_has_an_interval():
    before = {seed: outcome(10.0) for seed in range(3)}
    after = {seed: outcome(10.0 + seed) for seed in range(3)}
    row = assertion.row({"before": before, "after": after, "baseline": before}, range(3))
    assert row["needless_pct"] == 0
    assert row["after_slower_pct"] == pytest.approx(10)
    assert row["ci95_after_slower"] == pytest.approx((10 - 4.303 * 10 / 3**0.5, 10 + 4.303 * 10 / 3**0.5), abs=0.01)
    assert row["ci95_baseline_slower"] == (-math.inf, math.inf), "three that are equal tell nothing of others"
