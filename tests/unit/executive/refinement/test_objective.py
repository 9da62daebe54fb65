"""The objective sums the predictions of the models, and is INVALID for choices that are not allowed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.arrivals import displacements
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.errors import UsageError
from tests.support.synthetic_models import MODELS, NotANumber, PoseDuration, approach_dribble


def exact(**given) -> RefinementSettings:
    """Exact arrivals and free failures by default."""
    return RefinementSettings(**{"arrival_spread": (), "risk_cost_s": 0.0} | given)


CANDIDATES = np.array([[0.0, 0.1], [0.5, 0.3], [-0.8, 0.0]])


def objective(settings: RefinementSettings, given: ActionSequence | None = None, models: Models = MODELS):
    given = given or approach_dribble()
    return SequenceObjective(given.within(settings.horizon), given.variables, models, settings)


def arguments(angle: float, speed: float) -> tuple[np.ndarray, np.ndarray]:
    approach = np.array([[-1.0, 0.0, 0.0, 0.0, 1.0, 0.0, angle, speed]])
    dribble = np.array([[1.0, 0.0, angle, speed, 0.0, 1.5, 2.6, 0.0]])
    return approach, dribble


def test_cost_is_mean_plus_k_standard_deviations_of_every_action():
    cost = objective(exact(k_std=2.0, p_fail_max=1.0))(CANDIDATES)
    for value, (angle, speed) in zip(cost, CANDIDATES, strict=True):
        approach, dribble = arguments(angle, speed)
        first = MODELS.durations["goToPose/duration"].predict(approach)
        second = MODELS.durations["dribbleBall/duration"].predict(dribble)
        expected = first[0] + 2 * first[1] + second[0] + 2 * second[1]
        assert value == pytest.approx(expected[0])


def test_equal_starts_count_once():
    given = replace(approach_dribble(), starts=({1: 0.5},))
    found = given.starting_from([{2: 0.1}, {2: 0.2}, {2: 0.1}])
    assert found.starts == ({1: 0.5, 2: 0.1}, {1: 0.5, 2: 0.2})
    assert given.starting_from([]) is given


def test_horizon_one_is_the_first_action_alone():
    cost = objective(exact(horizon=1, k_std=0.0))(CANDIDATES)
    first = MODELS.durations["goToPose/duration"].predict(arguments(*CANDIDATES[1])[0])[0]
    assert cost[1] == pytest.approx(first[0])


def test_likely_failure_is_invalid():
    settings = exact(p_fail_max=0.05)
    angles = np.linspace(-3, 3, 61)
    cost = objective(settings)(np.column_stack([angles, np.zeros(61)]))
    failing = 1 - MODELS.successes["goToPose/success"].probability(np.vstack([arguments(a, 0)[0] for a in angles]))
    np.testing.assert_array_equal(np.isinf(cost), failing > 0.05)


def test_accepted_risk_of_an_action_replaces_the_limit():
    given = approach_dribble()
    risky = replace(given, actions=(replace(given.actions[0], risk=1.0), given.actions[1]))
    candidate = np.array([[2.0, 0.0]])
    assert np.isinf(objective(exact())(candidate))
    assert np.isfinite(objective(exact(), risky)(candidate))


def test_risk_costs_seconds():
    candidate = np.array([[0.95, 0.1]])
    free = objective(exact(p_fail_max=1.0))(candidate)
    priced = objective(exact(p_fail_max=1.0, risk_cost_s=10.0))(candidate)
    failure = 1 - MODELS.successes["goToPose/success"].probability(arguments(0.95, 0.1)[0])
    assert priced - free == pytest.approx(10 * failure)


def test_energy_costs_its_weight():
    models = Models(MODELS.durations | {"goToPose/energy": PoseDuration(), "dribbleBall/energy": PoseDuration()},
                    MODELS.successes)  # fmt: skip
    plain = objective(exact(k_std=0.0))(CANDIDATES[:1])
    priced = objective(exact(k_std=0.0, energy_weight=0.1), None, models)(CANDIDATES[:1])
    energy = sum(PoseDuration().predict(one)[0] for one in arguments(*CANDIDATES[0]))
    assert priced - plain == pytest.approx(0.1 * energy)


def test_prediction_that_is_not_a_number_is_invalid():
    models = Models({"goToPose/duration": NotANumber(), "dribbleBall/duration": PoseDuration()}, MODELS.successes)
    cost = objective(exact(), None, models)(np.array([[0.2, 0.1], [-0.2, 0.1]]))
    assert np.isinf(cost[0])
    assert np.isfinite(cost[1])


def test_missing_model_is_named():
    with pytest.raises(UsageError, match="dribbleBall/duration"):
        objective(exact(), None, Models({"goToPose/duration": PoseDuration()}, MODELS.successes))


def test_displaced_arrivals_average_the_second_action_only():
    settings = exact(k_std=0.0, arrival_spread=(("phi", 0.2),))
    cost = objective(settings)(CANDIDATES[:1])[0]
    angle, speed = CANDIDATES[0]
    first = MODELS.durations["goToPose/duration"].predict(arguments(angle, speed)[0])[0][0]
    off = 0.2 * np.sqrt(1.5)  # two points and the middle have a standard deviation of 0.2
    second = [
        MODELS.durations["dribbleBall/duration"].predict(arguments(angle + off, speed)[1])[0][0]
        for off in (-off, 0.0, off)
    ]
    assert cost == pytest.approx(first + np.mean(second))


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_displacements_have_mean_zero_and_the_requested_covariance(count):
    quantities = [*["a", "b", "c", "d"][:count], "exact"]
    std = {"a": 0.1, "b": 0.2, "c": 0.3, "d": 0.4}
    points = displacements(quantities, std)
    assert points.shape == (2 + count, count + 1)
    np.testing.assert_array_equal(points[0], 0)
    np.testing.assert_allclose(points.mean(axis=0), 0, atol=1e-12)
    covariance = points.T @ points / (count + 2)
    np.testing.assert_allclose(covariance, np.diag([std[q] ** 2 for q in quantities[:-1]] + [0]), atol=1e-12)


@pytest.mark.parametrize("spread", [0.2, 20.0, 1e6])
def test_arrivals_lie_within_half_a_turn_of_an_angle_however_wide_they_spread(spread):
    dribble = objective(exact(arrival_spread=(("phi", spread),))).stages[1]
    off = dribble.parameters(CANDIDATES[:1])[:, 2] - CANDIDATES[0, 0]
    asked = spread * np.sqrt(1.5) * np.array([0.0, 1.0, -1.0])
    assert (np.abs(off) <= np.pi + 1e-9).all()
    np.testing.assert_allclose(np.cos(off), np.cos(asked), atol=1e-6)
    np.testing.assert_allclose(np.sin(off), np.sin(asked), atol=1e-6)


def test_settings_out_of_range_are_refused_by_name():
    for wrong in ({"horizon": 0}, {"k_std": -1.0}, {"p_fail_max": 1.5}, {"batch": 0}, {"risk_cost_s": float("nan")}):
        with pytest.raises(UsageError, match=next(iter(wrong))):
            RefinementSettings(**wrong)
