"""Success beside objects: rows from the belief multiply, subgoals lead around, and a changed object is noticed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.assertion.assertion import Assertion
from tailor.executive.refinement.context_monitor import ContextMonitor
from tailor.executive.refinement.objective.context_success import ContextSuccess
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence, Failure
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.objective.stage_models import models_of
from tailor.executive.refinement.refinement import Refinement
from tailor.schemas import messages as m
from tailor.schemas.errors import UsageError
from tailor.tools.viewer.explanations.decided_sequence import sequence_of
from tests.support.random_trees import Trees
from tests.support.synthetic_models import DRIBBLE, MODELS, ConeSuccess, sequence
from tests.unit.executive.refinement.synthetic_context import (
    APPROACH_AROUND,
    BESIDE,
    CONTEXT,
    GO_AROUND,
    LIBRARY,
    ClearanceSuccess,
    beside,
)

START = {"x": -2.0, "y": 0.0, "phi": 0.0, "v": 0.0}
GOAL = {"x": 2.0, "y": 0.0, "phi": 0.0, "v": 0.0}
IN_THE_WAY = (0.0, 0.05, 0.2)
ASIDE = (0.0, 1.8, 0.2)
EXACT = RefinementSettings(arrival_spread=(), certify_checks=0)


def asserted(given: ActionSequence, settings: RefinementSettings = EXACT, models: Models = BESIDE):
    return Assertion(given, models, settings, np.random.default_rng(0)).advance(CheckBudget(2000))


def names(result) -> list[str]:
    assert isinstance(result, ActionSequence), result
    return [action.action.name for action in result.actions]


def success_of(instance, arguments) -> np.ndarray:
    return models_of(instance, BESIDE, EXACT).success.probability(arguments)


ARGUMENTS = np.array([[-2.0, 0, 0, 0, 2.0, 0, 0, 0], [-2.0, 1, 0, 0, 2.0, 1, 0, 0]])


def test_beside_objects_durations_are_those_of_the_model_calibrated_there():
    apart = object()
    models = replace(BESIDE, durations={**BESIDE.durations, f"{GO_AROUND.duration_model}_beside": apart})
    own = BESIDE.durations[GO_AROUND.duration_model]
    for discs, loaded, expected in (([IN_THE_WAY], models, apart), ([], models, own), ([IN_THE_WAY], BESIDE, own)):
        [instance] = beside(discs, [GO_AROUND], [START, GOAL]).actions
        assert models_of(instance, loaded, EXACT).duration is expected


def test_probabilities_of_several_objects_multiply_in_one_model_call():
    rows = ((0.0, 0.35, 0.2), (1.0, -0.4, 0.25))
    model = ClearanceSuccess()
    given = beside(rows, [GO_AROUND], [START, GOAL])
    loaded = Models(MODELS.durations, {"goToPose/clearance": model})
    success = models_of(given.actions[0], loaded, EXACT).success.probability(ARGUMENTS)
    assert model.calls == 1
    alone = [ClearanceSuccess().probability(np.hstack([ARGUMENTS, np.tile(row, (2, 1))])) for row in rows]
    assert success == pytest.approx(alone[0] * alone[1], rel=1e-12)


def test_an_action_that_fails_by_itself_also_fails_beside_objects():
    given = beside((ASIDE,), [APPROACH_AROUND], [START, {**GOAL, "phi": 0.9}])
    arguments = np.array([[-2.0, 0, 0, 0, 2.0, 0, 0.9, 0]])
    by_itself = ConeSuccess().probability(arguments)
    assert 0.1 < by_itself[0] < 0.95
    assert success_of(given.actions[0], arguments) == pytest.approx(by_itself, abs=1e-9)


def test_without_objects_the_action_is_as_if_it_had_no_context():
    given = beside((), [GO_AROUND], [START, GOAL])
    assert not given.actions[0].may_fail
    assert models_of(given.actions[0], BESIDE, EXACT).success is None
    assert names(asserted(given)) == ["goToPose"]


def test_context_without_its_model_is_refused_even_without_objects():
    given = beside((), [GO_AROUND], [START, GOAL])
    with pytest.raises(UsageError, match="goToPose/clearance"):
        SequenceObjective(given.actions, given.variables, MODELS, EXACT)


WRONG_ROWS = (None, 3.0, np.zeros((2, 4)), [(1.0, 2.0, 0.1), (1.0,)], [("a", "b", "c")], [(None, object(), 1.0)])


@pytest.mark.parametrize("wrong", WRONG_ROWS)
def test_rows_of_another_width_than_the_columns_are_refused(wrong):
    fault = r"test_context\..*, rows of an action's context, returned .*, expected an array of shape \(m, 3\): obstac"
    with pytest.raises(UsageError, match=fault) as refused:
        replace(CONTEXT, rows=lambda belief: wrong).believed(())
    assert "\n" not in str(refused.value)


def test_objects_of_which_nobody_tells_whether_they_are_met_are_refused():
    near = ContextSuccess(None, ClearanceSuccess(), np.zeros((2, 3)), lambda arguments, rows: None)
    fault = r"may_meet of an action's context, returned None, expected an array of shape \(2, 5\)"
    with pytest.raises(UsageError, match=fault):
        near.factors(np.zeros((5, 8)))


def test_object_aside_asserts_nothing():
    assert names(asserted(beside((ASIDE,), [GO_AROUND], [START, GOAL]))) == ["goToPose"]


def test_object_in_the_way_asserts_a_copy_of_the_action_whose_way_leads_around():
    given = beside((IN_THE_WAY, ASIDE), [GO_AROUND], [START, GOAL])
    result = asserted(given)
    assert names(result) == ["goToPose", "goToPose"]
    assert [action.asserted for action in result.actions] == [True, False]
    assert all(action.context == given.actions[0].context for action in result.actions)
    search = Refinement(result, BESIDE, EXACT, np.random.default_rng(0))
    search.advance(CheckBudget(300))
    bound = result.bind(search.choice.values)
    for instance in bound.actions:
        leg = np.array([[bound.variables[i].value for i in instance.variables]])
        assert success_of(instance, leg)[0] >= 0.95


def test_first_leg_to_a_subgoal_before_another_action_has_the_objects_too():
    """The robot is near its ball, on the wrong side; an obstacle leaves one way around the ball."""
    start, ball = {"x": 3.0, "y": 0.0, "phi": 0.0, "v": 0.0}, {"x": 1.0, "y": 0.0, "phi": 0.0, "v": 0.0}
    given = beside(((1.0, 1.0, 0.3),), [APPROACH_AROUND, DRIBBLE], [start, ball, {**GOAL, "y": 1.5}])
    result = asserted(given)
    assert names(result)[:2] == ["goToPose", "approachBall"]
    assert result.actions[0].context
    search = Refinement(result, BESIDE, EXACT, np.random.default_rng(0))
    search.advance(CheckBudget(300))
    bound = result.bind(search.choice.values)
    leg = np.array([[bound.variables[i].value for i in bound.actions[0].variables]])
    assert success_of(bound.actions[0], leg)[0] >= 0.95


def test_walled_in_robot_says_that_no_subgoal_helps():
    ring = tuple((-2 + 0.45 * np.cos(a), 0.45 * np.sin(a), 0.3) for a in np.arange(8) * np.pi / 4)
    failure = asserted(beside(ring, [GO_AROUND], [START, GOAL]), replace(EXACT, compare_subgoals=False))
    assert isinstance(failure, Failure)
    assert "goToPose is predicted to fail" in failure.reason


def test_leg_to_a_subgoal_that_cannot_be_safe_is_accepted_at_its_least_risk():
    """The robot stands so near an object that any way is risky: up to p_fail_settle it goes on."""
    near = ((-2.0, 0.3, 0.2), IN_THE_WAY)
    given = beside(near, [GO_AROUND], [START, GOAL])
    away = np.array([[-2.0, 0, 0, 0, -2.0, -1, 0, 0]])
    assert success_of(given.actions[0], away)[0] == pytest.approx(0.5, abs=0.1)
    hard = replace(EXACT, compare_subgoals=False, p_fail_settle=0.65)
    result = asserted(given, hard)
    assert names(result)[-1] == "goToPose"
    assert all(action.risk is not None and action.risk >= 0.5 for action in result.actions[:1])


def test_where_every_way_is_risky_the_likeliest_one_is_taken():
    near = ((-2.0, 0.3, 0.2), IN_THE_WAY)
    given = beside(near, [GO_AROUND], [START, GOAL])
    result = asserted(given, replace(EXACT, compare_subgoals=False, p_fail_settle=0.2))
    assert len(names(result)) == 1 + EXACT.assertion_depth
    assert all(action.risk == 1.0 for action in result.actions)
    search = Refinement(result, BESIDE, EXACT, np.random.default_rng(0))
    search.advance(CheckBudget(300))
    assert search.choice.valid
    direct = beside(near, [GO_AROUND], [START, GOAL])
    assert search.choice.failure[0] < 1 - success_of(direct.actions[0], ARGUMENTS[:1])[0]


def test_trap_that_one_subgoal_does_not_lead_out_of_gets_two():
    """Walls on three sides of the robot: one subgoal is reached, or the goal from it, but not both."""
    walls = [(-1.2, y, 0.2) for y in np.arange(-0.9, 0.91, 0.3)]
    walls += [(x, side * 0.9, 0.2) for x in np.arange(-2.6, -1.3, 0.3) for side in (1, -1)]
    given, settings = beside(tuple(walls), [GO_AROUND], [START, GOAL]), replace(EXACT, risk_cost_s=30.0)
    result = asserted(given, settings)
    assert len(names(result)) == 3
    search = Refinement(result, BESIDE, settings, np.random.default_rng(0))
    search.advance(CheckBudget(800))
    assert max(search.choice.failure) < 0.05


def test_subgoal_action_that_has_none_itself_gets_no_second_subgoal():
    go, approach = replace(GO_AROUND, subgoal_action=""), replace(APPROACH_AROUND, subgoal_action="goToPose")
    ring = tuple((1 + 0.6 * np.cos(a), 0.6 * np.sin(a), 0.3) for a in np.arange(10) * np.pi / 5)
    start, ball = {"x": 3.0, "y": 0.0, "phi": 0.0, "v": 0.0}, {"x": 1.0, "y": 0.0, "phi": 0.0, "v": 0.0}
    given = beside(ring, [approach, DRIBBLE], [start, ball, {**GOAL, "y": 1.5}])
    failure = asserted(replace(given, library={action.name: action for action in (go, approach, DRIBBLE)}))
    assert isinstance(failure, Failure)
    assert failure.reason == "approachBall is predicted to fail even after 1 asserted subgoals"


def test_hopeless_way_is_not_taken_for_want_of_a_better_one():
    ring = tuple((-2 + 0.45 * np.cos(a), 0.45 * np.sin(a), 0.3) for a in np.arange(8) * np.pi / 4)
    assert isinstance(asserted(beside(ring, [GO_AROUND], [START, GOAL])), Failure)


def monitor(belief) -> ContextMonitor:
    return ContextMonitor(beside(belief, [GO_AROUND], [START, GOAL]))


@pytest.mark.parametrize(
    ("now", "changed"),
    [
        ([IN_THE_WAY, ASIDE], False),
        ([ASIDE, IN_THE_WAY], False),
        ([(0.09, 0.05, 0.2), ASIDE], False),
        ([(0.11, 0.05, 0.2), ASIDE], True),
        ([(0.0, 0.05, 9.0), ASIDE], False),  # the radius has no tolerance: any is accepted
        ([IN_THE_WAY], True),
        ([IN_THE_WAY, ASIDE, (3.0, 2.0, 0.2)], True),
        ([IN_THE_WAY, IN_THE_WAY], True),
        ([], True),
    ],
)
def test_only_a_new_lost_or_moved_object_is_a_change(now, changed):
    assert monitor([IN_THE_WAY, ASIDE]).objects_changed(now) is changed


def test_one_of_two_objects_side_by_side_that_leaves_is_a_change():
    beside_it = (0.05, 0.05, 0.2)
    assert monitor([IN_THE_WAY, beside_it]).objects_changed([IN_THE_WAY, ASIDE])
    assert monitor([IN_THE_WAY, ASIDE]).objects_changed([IN_THE_WAY, beside_it])


def test_actions_without_a_context_are_not_asked():
    assert not ContextMonitor(sequence([DRIBBLE], [START, GOAL])).objects_changed(None)
    assert LIBRARY["dribbleBall"].context is None


def test_explanation_of_a_recorded_decision_has_its_objects():
    given = beside((IN_THE_WAY,), [GO_AROUND], [START, {**GOAL, "phi": (-1.0, 1.0)}])
    message = recorded(given)
    objects = m.Contexts(0, 5, (m.ActionObjects("goToPose", CONTEXT.names, IN_THE_WAY),))
    for noted, rows in ((objects, given.actions[0].context), (None, ()), (replace(objects, tick=4), ())):
        rebuilt = sequence_of(message, LIBRARY, noted)
        assert rebuilt is not None
        assert rebuilt.actions[0].context == rows


def recorded(given: ActionSequence) -> m.Subgoals:
    """The message that reports a sequence of one action, in tick 5."""
    action = given.actions[0]
    parameters = tuple(
        m.Parameter(p.name, v.id, v.label, v.unit, v.value is not None, v.lower, v.upper, v.value or 0.0)
        for p, v in zip(action.action.parameters, (given.variables[i] for i in action.variables), strict=True)
    )
    return m.Subgoals(0, 5, 2, (m.InstantiatedAction("goToPose", 1, False, 1.0, 0.1, parameters),))


def test_objects_that_cannot_be_met_cost_no_model_call_and_no_success():
    rows = np.array([(0.0, 0.35, 0.2), (1.0, -0.4, 0.25), (0.0, 9.0, 0.2)])
    every = ContextSuccess(None, ClearanceSuccess(), rows[:2]).probability(ARGUMENTS)
    model = ClearanceSuccess()
    some = ContextSuccess(None, model, rows, lambda arguments, rows: np.abs(rows[:, [1]] - arguments[:, 1]) < 2.0)
    assert some.probability(ARGUMENTS) == pytest.approx(every, rel=1e-12)
    assert model.calls == 1
    none = ContextSuccess(None, model, rows, lambda arguments, rows: np.zeros((3, len(arguments)), bool))
    assert none.probability(ARGUMENTS).tolist() == [1.0, 1.0]
    assert model.calls == 1


@pytest.mark.parametrize("may_meet", [None, lambda arguments, rows: np.zeros((len(rows), len(arguments)), bool)])
def test_objects_without_bounds_or_perhaps_left_out_do_not_lower_the_bound_of_success(may_meet):
    own, beside = Trees.random(1, success=True), Trees.random(2, "one-obstacle", success=True)
    beside = beside if may_meet else ClearanceSuccess()
    bounds = ContextSuccess(own, beside, np.array([IN_THE_WAY, ASIDE]), may_meet).bounds
    columns = tuple(np.full((1, 1, 1), value) for value in ARGUMENTS[0])
    for restricted in (bounds, bounds.within(columns, columns)):
        assert restricted.upper_bound(columns, columns) == own.bounds.upper_bound(columns, columns)
        assert [bound.item() for bound in restricted.upper_bounds(columns, columns)][1] == 1.0
    assert ContextSuccess(ConeSuccess(), beside, np.array([ASIDE]), may_meet).bounds is None


def test_an_action_tells_which_objects_it_may_meet():
    context = replace(CONTEXT, may_meet=lambda arguments, rows: np.zeros((len(rows), len(arguments)), bool))
    given = beside((IN_THE_WAY,), [replace(GO_AROUND, context=context)], [START, GOAL])
    given = replace(given, actions=tuple(replace(each, context=(IN_THE_WAY,)) for each in given.actions))
    assert success_of(given.actions[0], ARGUMENTS).tolist() == [1.0, 1.0]
