"""Subgoal assertion inserts a subgoal before an action that is predicted to fail, or fails with a reason."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.assertion.assertion import Assertion
from tailor.executive.refinement.objective.sequence import ActionSequence, Failure
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.refinement import Refinement
from tests.support.synthetic_models import APPROACH, DRIBBLE, GO, LIBRARY, MODELS, ConeSuccess, NeverSucceeds, sequence

HARD = RefinementSettings(compare_subgoals=False, risk_cost_s=6.0)  # the paper's: a threshold decides
SETTINGS = replace(HARD, arrival_spread=(), p_fail_assert=0.05, risk_cost_s=0.0)
TARGET = {"x": 0.0, "y": 1.5, "phi": 2.6, "v": 0.0}


def approach(robot_x: float, angle: tuple[float, float], actions: tuple[Action, ...] = (APPROACH, DRIBBLE)):
    """An approach of a ball at (1, 0) from (robot_x, 0), with limits on the angle at the ball."""
    start = {"x": robot_x, "y": 0.0, "phi": 0.0, "v": 0.0}
    ball = {"x": 1.0, "y": 0.0, "phi": angle, "v": (0.0, 0.3)}
    return sequence(list(actions), [start, ball, TARGET])


def asserted(given: ActionSequence, settings=SETTINGS, models=MODELS):
    return Assertion(given, models, settings, np.random.default_rng(0)).advance(CheckBudget(1000))


def names(result) -> list[str]:
    assert isinstance(result, ActionSequence)
    return [action.action.name for action in result.actions]


def test_approach_that_will_succeed_is_left_as_it_is():
    given = approach(-1.0, (-0.3, 0.3))
    result = asserted(given)
    assert names(result) == ["approachBall", "dribbleBall"]
    assert result.variables == given.variables


def test_one_value_that_succeeds_is_enough():
    assert names(asserted(approach(3.0, (-3.0, 3.0)))) == ["approachBall", "dribbleBall"]


def test_approach_that_fails_for_every_angle_gets_a_subgoal_with_a_free_goal():
    given = approach(3.0, (-0.3, 0.3))
    result = asserted(given)
    assert names(result) == ["goToPose", "approachBall", "dribbleBall"]
    to_subgoal, approach_ball, dribble = result.actions
    assert to_subgoal.asserted
    assert not approach_ball.asserted
    assert to_subgoal.variables[:4] == given.actions[0].variables[:4]
    assert to_subgoal.variables[4:] == approach_ball.variables[:4] == (12, 13, 14, 15)
    assert approach_ball.variables[4:] == dribble.variables[:4] == given.actions[0].variables[4:]
    goal = [result.variables[i] for i in to_subgoal.variables[4:]]
    assert [(v.lower, v.upper, v.free) for v in goal] == [(p.lower, p.upper, True) for p in GO.parameters[4:]]


def test_refinement_puts_the_subgoal_where_success_is_predicted():
    settings = replace(HARD, arrival_spread=(("x", 0.03), ("y", 0.03), ("phi", 0.1)))
    result = asserted(approach(3.0, (-0.3, 0.3)), settings)
    refinement = Refinement(result, MODELS, settings, np.random.default_rng(0))
    refinement.advance(CheckBudget(200))
    choice = refinement.choice
    assert choice.valid
    assert len(choice.predicted_s) == 3
    bound = result.bind(choice.values)
    arguments = np.array([[bound.variables[i].value for i in bound.actions[1].variables]])
    assert MODELS.successes["goToPose/success"].probability(arguments)[0] >= 0.95


@pytest.mark.parametrize("compare", [False, True])
def test_action_after_a_subgoal_may_risk_less_than_one_without(compare):
    settings = replace(SETTINGS, compare_subgoals=compare, risk_cost_s=20.0, p_fail_max=0.01, p_fail_assert=0.3)
    result = asserted(approach(3.0, (-0.3, 0.3)), settings)
    assert names(result) == ["goToPose", "approachBall", "dribbleBall"]
    refinement = Refinement(result, MODELS, replace(settings, risk_cost_s=0.0), np.random.default_rng(0))
    refinement.advance(CheckBudget(300))
    assert refinement.choice.failure[1] <= 0.01


def test_subgoal_does_not_count_in_the_horizon():
    result = asserted(approach(3.0, (-0.3, 0.3)))
    assert [action.action.name for action in result.within(1)] == ["goToPose", "approachBall"]
    assert len(result.within(2)) == 3


def test_only_actions_in_the_horizon_are_checked():
    start, ball = {"x": 3.0, "y": 0.0, "phi": 0.0, "v": 0.0}, {"x": 1.0, "y": 0.0, "phi": 0.0, "v": 0.0}
    given = sequence([DRIBBLE, APPROACH], [TARGET, start, ball])
    assert names(asserted(given, replace(SETTINGS, horizon=1))) == ["dribbleBall", "approachBall"]
    assert names(asserted(given)) == ["dribbleBall", "goToPose", "approachBall"]


def test_action_without_a_subgoal_fails_with_a_reason():
    lonely = replace(APPROACH, subgoal_action="")
    failure = asserted(approach(3.0, (-0.3, 0.3), (lonely, DRIBBLE)))
    assert isinstance(failure, Failure)
    assert "approachBall" in failure.reason
    assert "no subgoal action" in failure.reason


def test_hopeless_action_fails_after_the_bounded_depth():
    hopeless = Models(MODELS.durations, {"goToPose/success": NeverSucceeds()})
    failure = asserted(approach(-1.0, (-3.0, 3.0)), replace(HARD, assertion_depth=2), hopeless)
    assert isinstance(failure, Failure)
    assert "after 2 asserted subgoals" in failure.reason


def test_subgoal_action_that_is_itself_predicted_to_fail_is_a_failure():
    """A subgoal action with a success model of its own is checked too; the depth bounds the whole unit."""
    wary = replace(GO, success_model="goToPose/success")
    given = replace(
        approach(3.0, (-0.3, 0.3)), library=LIBRARY | {"goToPose": replace(wary, subgoal_action="goToPose")}
    )
    models = Models(MODELS.durations, {"goToPose/success": NeverSucceeds()})
    assert isinstance(asserted(given, models=models), Failure)


def test_limit_of_the_failure_probability_decides():
    """From the side success is likely, not certain: a strict limit asserts a subgoal, a lax one does not."""
    start, ball = {"x": 1.0, "y": -2.0, "phi": 0.0, "v": 0.0}, {"x": 1.0, "y": 0.0, "phi": 0.65, "v": 0.0}
    given = sequence([APPROACH], [start, ball])
    probability = ConeSuccess().probability(np.array([[1, -2, 0, 0, 1, 0, 0.65, 0.0]]))[0]
    assert 0.5 < probability < 0.95
    assert names(asserted(given)) == ["goToPose", "approachBall"]
    assert names(asserted(given, replace(SETTINGS, p_fail_assert=0.4))) == ["approachBall"]


def test_displaced_arrivals_must_succeed_too():
    """The limit applies to displaced arrivals, not only to the subgoal itself."""
    wide = replace(HARD, arrival_spread=(("x", 0.05), ("y", 0.05)))
    result = asserted(approach(3.0, (-0.3, 0.3)), wide)
    worst = []
    for settings in (SETTINGS, wide):
        refinement = Refinement(result, MODELS, settings, np.random.default_rng(0))
        refinement.advance(CheckBudget(200))
        bound = result.bind(refinement.choice.values)
        at = np.array([[bound.variables[i].value for i in bound.actions[1].variables]] * 9)
        at[:, :2] += 0.07 * np.array([[i, j] for i in (-1, 0, 1) for j in (-1, 0, 1)])
        worst.append(MODELS.successes["goToPose/success"].probability(at).min())
    assert worst[1] > worst[0]
    assert worst[1] > 0.85


@pytest.mark.parametrize("slice_checks", [1, 2])
def test_slices_give_what_one_run_gives(slice_checks):
    given = approach(3.0, (-0.3, 0.3))
    sliced = Assertion(given, MODELS, SETTINGS, np.random.default_rng(0))
    results = [sliced.advance(CheckBudget(slice_checks)) for _ in range(20)]
    assert results[0] is None
    assert results[-1] == asserted(given)


class TwoSecondsAndOneAMetre:
    """Every action takes 2 s and 1 s a metre, so a subgoal always costs time."""

    def predict(self, arguments):
        distance = np.hypot(*(arguments[:, 4:6] - arguments[:, :2]).T)
        return 2 + distance, np.zeros(len(arguments))


PLAIN = Models({"goToPose/duration": TwoSecondsAndOneAMetre()}, MODELS.successes)
FROM_THE_SIDE = sequence(
    [APPROACH],
    [{"x": 1.0, "y": -2.0, "phi": 0.0, "v": 0.0}, {"x": 1.0, "y": 0.0, "phi": 0.65, "v": 0.0}],
)


@pytest.mark.parametrize(("price_s", "expected"), [(1.0, ["approachBall"]), (100.0, ["goToPose", "approachBall"])])
def test_subgoal_is_asserted_only_at_a_lower_expected_cost(price_s, expected):
    """An approach that fails in three of ten tries: a cheap failure is risked, an expensive one is avoided."""
    settings = replace(SETTINGS, compare_subgoals=True, risk_cost_s=price_s)
    result = asserted(FROM_THE_SIDE, settings, PLAIN)
    assert names(result) == expected
    refinement = Refinement(result, PLAIN, settings, np.random.default_rng(0))
    refinement.advance(CheckBudget(50))
    assert refinement.choice.valid


def test_comparison_resumes_where_the_budget_stopped_it():
    settings = replace(SETTINGS, compare_subgoals=True, risk_cost_s=100.0)
    sliced = Assertion(FROM_THE_SIDE, PLAIN, settings, np.random.default_rng(0))
    results = [sliced.advance(CheckBudget(3)) for _ in range(60)]
    assert results[0] is None
    assert results[-1] == asserted(FROM_THE_SIDE, settings, PLAIN)


class AtBest:
    """A model whose success probability is at most `best`, and that only inside the cone."""

    def __init__(self, best):
        self.best = best

    def probability(self, arguments):
        return self.best * ConeSuccess().probability(arguments)


def test_least_risk_is_accepted_if_no_start_keeps_the_limit():
    """The subgoal lies where success is likeliest, at the remaining risk."""
    unsure = Models(MODELS.durations, {"goToPose/success": AtBest(0.86)})
    result = asserted(approach(3.0, (-0.3, 0.3)), models=unsure)
    assert names(result) == ["goToPose", "approachBall", "dribbleBall"]
    assert 0.14 < result.actions[1].risk < 0.25
    refinement = Refinement(result, unsure, SETTINGS, np.random.default_rng(0))
    refinement.advance(CheckBudget(100))
    assert refinement.choice.valid


def test_subgoal_that_does_not_lower_the_risk_is_not_asserted():
    unsure = Models(MODELS.durations, {"goToPose/success": AtBest(0.86)})
    result = asserted(approach(-1.0, (-0.3, 0.3)), models=unsure)
    assert names(result) == ["approachBall", "dribbleBall"]
    assert 0.14 < result.actions[0].risk < 0.25


def test_failure_that_is_likely_everywhere_is_a_failure():
    against = Models(MODELS.durations, {"goToPose/success": AtBest(0.3)})
    assert isinstance(asserted(approach(3.0, (-0.3, 0.3)), models=against), Failure)


def test_arrival_beside_the_subgoal_asserts_no_second_subgoal():
    """Between p_fail_max and p_fail_assert an approach continues at its own risk."""
    start, ball = {"x": 1.0, "y": -2.0, "phi": 0.0, "v": 0.0}, {"x": 1.0, "y": 0.0, "phi": 0.72, "v": 0.0}
    risk = 1 - ConeSuccess().probability(np.array([[1, -2, 0, 0, 1, 0, 0.72, 0.0]]))[0]
    lenient = replace(SETTINGS, p_fail_assert=0.2)
    assert lenient.p_fail_max < risk < lenient.p_fail_assert
    result = asserted(sequence([APPROACH], [start, ball]), lenient)
    assert names(result) == ["approachBall"]
    refinement = Refinement(result, MODELS, lenient, np.random.default_rng(0))
    refinement.advance(CheckBudget(10))
    assert refinement.choice.valid


def test_subgoal_is_compared_even_if_no_start_is_certain():
    """A model with at most 86 % success still distinguishes a good start from a bad one."""
    unsure = Models({"goToPose/duration": TwoSecondsAndOneAMetre()}, {"goToPose/success": AtBest(0.86)})
    settings = replace(SETTINGS, compare_subgoals=True, risk_cost_s=20.0, p_fail_assert=0.2)
    behind = sequence(
        [APPROACH], [{"x": 3.0, "y": 0.0, "phi": 0.0, "v": 0.0}, {"x": 1.0, "y": 0.0, "phi": 0.0, "v": 0.0}]
    )
    assert names(asserted(behind, settings, unsure)) == ["goToPose", "approachBall"]
