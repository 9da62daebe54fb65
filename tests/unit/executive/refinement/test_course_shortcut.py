"""An asserted subgoal is dropped once the way without it is shorter and hardly likely to fail."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tailor.executive.refinement.assertion.asserted_subgoal import with_subgoal
from tailor.executive.refinement.course_shortcut import shortcut
from tailor.executive.refinement.objective.choice import Choice
from tailor.executive.refinement.objective.settings import RefinementSettings
from tests.support.synthetic_models import PI
from tests.unit.executive.refinement.synthetic_context import BESIDE, GO_AROUND, beside
from tests.unit.executive.refinement.test_rolling_start import at_rest

START = {"x": -2.0, "y": 0.0, "phi": 0.0, "v": 0.0}
GOAL = {"x": 2.0, "y": 0.0, "phi": 0.0, "v": 0.0}
WALL = (0.0, 0.0, 0.2)
SUBGOAL = {"x": 0.0, "y": 1.0, "phi": 0.0, "v": 0.3}
EXACT = RefinementSettings(arrival_spread=(), certify_checks=0)


def shortened(start, objects=(WALL,), settings=EXACT, go=GO_AROUND, accepted=(0.0, 0.0)):
    """What is found from `start` on the way around a wall that lay between start and goal."""
    decided = with_subgoal(beside((WALL,), [go], [START, GOAL]), 0)
    values = {variable.id: SUBGOAL[variable.quantity] for variable in decided.free()}
    now = beside(objects, [go], [{**START, **start}, GOAL])
    choice = Choice(values, (2.0, 2.0), (0.1, 0.1), accepted, 4.0, True)
    return shortcut(decided, choice, now, BESIDE, settings)


def test_subgoal_is_kept_while_the_object_is_in_the_way():
    assert shortened({"x": -1.9}) is None


@pytest.mark.parametrize(
    ("start", "objects"),
    [({"x": -0.6, "y": 1.4}, (WALL,)), ({"x": -1.9}, ((0.0, -1.5, 0.2),)), ({"x": -1.9}, ())],
    ids=["seen past it", "it stands elsewhere", "it is gone"],
)
def test_subgoal_is_dropped_where_the_straight_way_is_clear(start, objects):
    sequence, choice = shortened(start, objects)
    (action,) = sequence.actions
    assert not action.asserted
    names = (parameter.name for parameter in action.action.parameters)
    values = {name: sequence.variables[i].value for name, i in zip(names, action.variables, strict=True)}
    assert (values["x"], values["y"]) == (start["x"], start.get("y", 0.0))
    assert (values["xg"], values["yg"]) == (2.0, 0.0)
    assert choice.failure[0] < 0.01
    assert len(choice.predicted_s) == 1


def test_subgoal_that_is_nearly_reached_is_kept():
    assert shortened({"x": -0.1, "y": 1.0}) is None


def test_shortcut_that_probably_fails_is_not_taken_however_cheap_failures_are():
    beside_it = {"x": -1.0, "y": 0.42}  # the straight way passes 0.14 m from the wall: it fails in a fifth of the runs
    cheap = replace(EXACT, risk_cost_s=0.5)
    assert shortened(beside_it, settings=cheap) is None
    assert shortened(beside_it, settings=replace(cheap, p_fail_max=0.9)) is not None


@pytest.mark.parametrize(
    ("accepted", "post", "dropped"),
    [((0.1, 0.1), (0.9, 0.8, 0.2), True), ((0.1, 0.0), (0.9, 0.8, 0.2), False), ((0.1, 0.1), (3.0, 0.8, 0.2), False)],
    ids=["a post stands beside the subgoal", "less was accepted", "the way by the subgoal is clear"],
)
def test_shortcut_may_risk_what_the_course_risks_now_and_did_when_it_was_decided(accepted, post, dropped):
    beside_it = {"x": -0.8, "y": 0.5}  # the straight way fails in a ninth of the runs
    cheap = replace(EXACT, risk_cost_s=0.5)
    assert (shortened(beside_it, (WALL, post), cheap, accepted=accepted) is not None) is dropped


def test_robot_in_motion_has_to_be_safe_from_where_it_rolls_on_to_if_drives_begin_at_rest():
    """A post stands ahead, 0.4 m beside the straight way: the robot would turn to that after it had rolled on."""
    ahead, post = {"x": -0.6, "y": 1.0, "phi": 0.5 * PI}, (-0.6, 1.42, 0.2)
    standing, rolling = {**ahead, "v": 0.0}, {**ahead, "v": 0.3}
    assert shortened(standing, (post,), go=at_rest(GO_AROUND)) is not None
    assert shortened(rolling, (post,), go=at_rest(GO_AROUND)) is None
    assert shortened(rolling, (post,)) is not None, "models that know starts in motion are trusted"
