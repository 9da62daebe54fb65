"""Alternatives of a subgoal have the value of the objective, and greedy differs from refined."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.refinement.alternatives import Alternatives, alternatives
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.refinement import Refinement
from tests.support.synthetic_models import GO, MODELS, approach_dribble, sequence

SETTINGS = RefinementSettings(k_std=0.0, gain_k_std=0.0, arrival_spread=(), risk_cost_s=0.0)


def test_alternatives_agree_with_the_choice():
    given = approach_dribble()
    search = Refinement(given, MODELS, SETTINGS, np.random.default_rng(0))
    search.advance(CheckBudget(500))
    angle = next(variable.id for variable in given.free() if variable.quantity == "phi")
    predicted = _along(given, search.choice.values, SETTINGS)[angle]
    assert predicted.durations_s.shape == (2, 721)
    valid = np.isfinite(predicted.total_s)
    np.testing.assert_allclose(predicted.durations_s.sum(axis=0)[valid], predicted.total_s[valid])
    assert predicted.total_s.min() >= search.choice.total_s - 1e-9
    assert predicted.best == pytest.approx(search.choice.values[angle], abs=0.02)


def test_greedy_alternative_is_what_horizon_one_chooses():
    given = approach_dribble((1.0, -1.5, 1.5))
    alone = Refinement(given, MODELS, replace(SETTINGS, horizon=1), np.random.default_rng(0))
    alone.advance(CheckBudget(500))
    angle = next(variable.id for variable in given.free() if variable.quantity == "phi")
    predicted = _along(given, alone.choice.values, SETTINGS)[angle]
    assert predicted.greedy == pytest.approx(alone.choice.values[angle], abs=0.02)
    assert predicted.best != pytest.approx(predicted.greedy, abs=0.05)


PLACES = [{"x": 0.0, "y": 0.0, "phi": 0.0, "v": 0.0}, {"x": 1.0, "y": 1.0, "phi": 0.5, "v": 0.0}, {"x": 2.0, "y": 0.0}]
END = {"x": 3.0, "y": 1.0, "phi": 0.5, "v": 0.0}


@pytest.mark.parametrize(
    "given",
    [approach_dribble(), sequence([GO] * 3, [*PLACES, END]), sequence([GO], PLACES[:2])],
    ids=["two free", "the first action depends on none", "nothing free"],
)
def test_alternatives_are_those_of_each_candidate_predicted_alone(given):
    objective = _objective(given, replace(SETTINGS, horizon=3))
    chosen = objective.ranges.lower + 0.3 * objective.ranges.width
    for column, predicted in enumerate(alternatives(objective, chosen, 9)):
        for index, value in enumerate(predicted.values):
            candidate = chosen.copy()
            candidate[column] = value
            durations_s = [float(each.duration_s[0]) for each in objective.predict(candidate)]
            np.testing.assert_allclose(predicted.durations_s[:, index], durations_s, rtol=1e-12)
            assert predicted.total_s[index] == pytest.approx(float(objective(candidate[None])[0]), rel=1e-12)


def test_bound_variable_has_no_alternatives():
    given = approach_dribble()
    assert set(_along(given, {}, SETTINGS)) == {variable.id for variable in given.free()}


def _objective(given: ActionSequence, settings: RefinementSettings) -> SequenceObjective:
    return SequenceObjective(given.within(settings.horizon), given.variables, MODELS, settings)


def _along(given: ActionSequence, chosen: Mapping[int, float], settings: RefinementSettings) -> dict[int, Alternatives]:
    objective = _objective(given, settings)
    return {each.variable: each for each in alternatives(objective, objective.vector(chosen), 721)}
