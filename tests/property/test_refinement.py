"""Refinement is anytime: never worse with more budget, the same in slices, always within ranges and constraints."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.refinement.assertion.assertion import Assertion
from tailor.executive.refinement.greedy import GreedySearch
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.ranges import Ranges
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.refinement import Refinement
from tests.support.synthetic_models import MODELS, approach_dribble, sequence, waypoints, within

SOLVERS = ("chain", "genetic", "differential")
SPREAD = (("x", 0.03), ("y", 0.03), ("phi", 0.1))
seeds = st.integers(0, 2**32 - 1)


def task(kind: str, seed: int) -> ActionSequence:
    rng = np.random.default_rng([1, seed])
    if kind == "waypoints":
        return waypoints(3, rng)
    if kind == "approach":
        return approach_dribble(tuple(rng.uniform((-3, -2, -3), (3, 2, 3))))
    fixed = approach_dribble((3.0, 0.0, 0.0))
    narrow = {"x": 1.0, "y": 0.0, "phi": (-0.3, 0.3), "v": (0.0, 0.3)}
    start = {v.quantity: v.value for v in fixed.variables[:4]}
    target = {v.quantity: v.value for v in fixed.variables[8:]}
    asserted = Assertion(
        sequence([a.action for a in fixed.actions], [start, narrow, target]), MODELS, RefinementSettings(), rng
    ).advance(CheckBudget(100))
    assert isinstance(asserted, ActionSequence)
    return asserted


def refinement(kind: str, seed: int, solver: str, horizon: int = 3, gain_k_std: float = 0.0) -> Refinement:
    chosen = RefinementSettings(solver=solver, horizon=horizon, arrival_spread=SPREAD, batch=128, gain_k_std=gain_k_std)
    return Refinement(task(kind, seed), MODELS, chosen, np.random.default_rng(seed))


kinds = st.sampled_from(["waypoints", "approach", "subgoal"])
prices = st.sampled_from([0.0, 0.5, 2.0])


@settings(max_examples=25, deadline=None)
@given(kinds, seeds, st.sampled_from(SOLVERS))
def test_more_budget_is_never_worse(kind, seed, solver):
    search = refinement(kind, seed, solver)
    totals = []
    for _ in range(15):
        search.advance(CheckBudget(1))
        totals.append(search.choice.total_s)
    assert all(later <= earlier for earlier, later in pairwise(totals))
    assert search.report().best_s == totals[-1]


@settings(max_examples=25, deadline=None)
@given(kinds, seeds, st.sampled_from(SOLVERS), st.lists(st.integers(1, 5), min_size=1, max_size=6), prices)
def test_slices_equal_one_run_with_the_same_checks(kind, seed, solver, slices, price):
    whole, sliced = (refinement(kind, seed, solver, gain_k_std=price) for _ in range(2))
    whole.advance(CheckBudget(sum(slices)))
    for checks in slices:
        sliced.advance(CheckBudget(checks))
    assert whole.choice == sliced.choice
    assert whole.report() == sliced.report()


@settings(max_examples=25, deadline=None)
@given(kinds, seeds, st.sampled_from(SOLVERS), st.integers(1, 12))
def test_choice_is_always_within_ranges_and_constraints(kind, seed, solver, checks):
    given_sequence = task(kind, seed)
    search = refinement(kind, seed, solver)
    search.advance(CheckBudget(checks))
    choice = search.choice
    for identifier, value in choice.values.items():
        variable = given_sequence.variables[identifier]
        assert variable.free
        assert variable.lower <= value <= variable.upper
    if choice.valid:
        limits = [0.05 if action.risk is None else action.risk for action in given_sequence.within(3)]
        assert all(failure <= limit for failure, limit in zip(choice.failure, limits, strict=True))
        assert np.isfinite(choice.total_s)


@settings(max_examples=15, deadline=None)
@given(kinds, seeds, st.sampled_from(SOLVERS))
def test_first_check_answers_for_every_free_parameter_in_the_horizon(kind, seed, solver):
    search = refinement(kind, seed, solver, horizon=2)
    assert search.choice is None
    search.advance(CheckBudget(1))
    actions = task(kind, seed).within(2)
    variables = task(kind, seed).variables
    assert set(search.choice.values) == {i for action in actions for i in action.variables if variables[i].free}
    assert len(search.choice.predicted_s) == len(actions)
    assert search.report().checks == 1


@pytest.mark.parametrize("solver", SOLVERS)
def test_spent_budget_does_nothing(solver):
    search = refinement("approach", 0, solver)
    search.advance(CheckBudget(0))
    assert search.choice is None
    assert not search.finished


@pytest.mark.parametrize("solver", SOLVERS)
def test_finished_search_spends_no_more_checks(solver):
    search = refinement("approach", 0, solver)
    search.advance(CheckBudget(10_000))
    assert search.finished
    budget = CheckBudget(5)
    search.advance(budget)
    assert budget.granted == 0


def test_start_is_never_lost():
    """An earlier answer given as a start is matched or beaten at once after the greedy one."""
    best = refinement("waypoints", 4, "chain")
    best.advance(CheckBudget(10_000))
    again = Refinement(
        task("waypoints", 4),
        MODELS,
        RefinementSettings(horizon=3, arrival_spread=SPREAD, gain_k_std=0.0),
        np.random.default_rng(99),
        start=best.choice.values,
    )
    again.advance(CheckBudget(2))
    assert again.choice.total_s <= best.choice.total_s + 1e-9


def test_gain_that_is_too_small_leaves_the_greedy_choice():
    def searched(gain_min_s: float) -> Refinement:
        chosen = RefinementSettings(horizon=3, gain_min_s=gain_min_s, gain_k_std=0.0)
        search = Refinement(task("waypoints", 4), MODELS, chosen, np.random.default_rng(5))
        search.advance(CheckBudget(10_000))
        return search

    gain_s = searched(0.0).report().greedy_s - searched(0.0).choice.total_s
    assert gain_s > 0.01
    assert searched(gain_s * 0.9).choice == searched(0.0).choice
    greedy = searched(gain_s * 1.1)
    assert greedy.choice.total_s == greedy.report().greedy_s


@settings(max_examples=15, deadline=None)
@given(kinds, seeds, st.sampled_from(SOLVERS))
def test_a_kept_greedy_choice_begins_as_horizon_one_does(kind, seed, solver):
    """So a run that does not deviate takes as long as a greedy one."""
    kept = refinement(kind, seed, solver, gain_k_std=1e6)
    kept.advance(CheckBudget(10_000))
    alone = GreedySearch(task(kind, seed), MODELS, kept._settings, np.random.default_rng(1))
    alone.advance(CheckBudget(10_000))
    first = SequenceObjective(task(kind, seed).units()[0], task(kind, seed).variables, MODELS, kept._settings)
    costs = first(first.vectors([kept.choice.values, alone.values]))
    assert kept.report().best_s == kept.report().greedy_s
    assert costs[0] == pytest.approx(costs[1], abs=0.02)


@settings(max_examples=25, deadline=None)
@given(kinds, seeds, st.sampled_from(SOLVERS), prices)
def test_another_choice_than_the_greedy_one_is_better_by_the_price(kind, seed, solver, price):
    search = refinement(kind, seed, solver, gain_k_std=price)
    search.advance(CheckBudget(10_000))
    greedy, chosen = search._greedy_choice, search.choice
    assert search.finished
    deviation_s = np.sqrt(2 * np.sum(np.square(greedy.std_s)))
    if greedy.valid and chosen != greedy:
        assert greedy.total_s - chosen.total_s > price * deviation_s


@settings(max_examples=15, deadline=None)
@given(kinds, seeds, st.sampled_from(SOLVERS), prices)
def test_once_the_greedy_choice_is_known_more_budget_is_never_worse(kind, seed, solver, price):
    search = refinement(kind, seed, solver, gain_k_std=price)
    while search._solver is None:
        search.advance(CheckBudget(1))
    totals = []
    for _ in range(15):
        totals.append(search.choice.total_s)
        search.advance(CheckBudget(1))
    assert all(later <= earlier for earlier, later in pairwise(totals))


def test_sequence_without_free_parameters_is_finished_after_one_check():
    place = {"x": 0.0, "y": 0.0, "phi": 0.0, "v": 0.0}
    fixed = sequence([approach_dribble().actions[1].action], [place, place | {"x": 1.0}])
    search = Refinement(fixed, MODELS, RefinementSettings(), np.random.default_rng(0))
    search.advance(CheckBudget(3))
    assert search.finished
    assert search.choice.valid
    assert search.choice.values == {}


@given(st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=2), st.booleans())
def test_confined_values_lie_in_the_ranges(values, periodic):
    ranges = Ranges(np.array([-np.pi, 0.0]), np.array([np.pi, 0.3]), np.array([periodic, False]))
    confined = ranges.confine(np.array([values]))
    assert within(ranges, confined)
    if periodic:
        turns = (confined[0, 0] - values[0]) / (2 * np.pi)
        assert turns == pytest.approx(round(turns), abs=1e-6)


@given(st.integers(1, 40), seeds)
def test_draws_lie_in_the_ranges_and_cover_every_layer(count, seed):
    ranges = Ranges(np.array([-1.0, 0.0]), np.array([1.0, 0.3]), np.array([False, False]))
    drawn = ranges.draw(count, np.random.default_rng(seed))
    assert drawn.shape == (count, 2)
    assert within(ranges, drawn)
    layers = np.floor((drawn - ranges.lower) / ranges.width * count)
    assert all(len(set(column)) == count for column in layers.T)
