"""A certificate is sound: no choice costs less than its bound; more budget never weakens it, slices equal one run."""

from __future__ import annotations

import weakref
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.certificates.bound_stagnation import PATIENCE, BoundStagnation
from tailor.executive.refinement.certificates.certificate import Certificate, certificate
from tailor.executive.refinement.certificates.stage_bounds import NoBound
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.selection import solver_for
from tailor.runtime.gc_freeze import gc_disabled
from tests.property import examples
from tests.support.random_trees import Trees
from tests.support.synthetic_models import APPROACH, DRIBBLE, GO, MODELS, approach_dribble, sequence, waypoints, within

seeds = st.integers(0, 2**32 - 1)
kinds = st.sampled_from(["waypoints", "approach", "subgoal", "two places"])
SPREAD = (("x", 0.05), ("y", 0.05), ("phi", 0.1), ("v", 0.05))


def task(kind: str, seed: int) -> ActionSequence:
    rng = np.random.default_rng([2, seed])
    if kind == "waypoints":
        return waypoints(3, rng)
    if kind == "approach":
        return approach_dribble(tuple(rng.uniform((-3, -2, -3), (3, 2, 3))))
    start = {"x": rng.uniform(-3, 3), "y": rng.uniform(-2, 2), "phi": 0.0, "v": 0.0}
    ball = {"x": 1.0, "y": 0.0, "v": (0.0, 0.3)}
    target = {"x": 0.0, "y": 1.5, "phi": 2.6, "v": 0.0}
    if kind == "subgoal":
        return sequence([GO, APPROACH, DRIBBLE], [start, {}, ball, target])
    return sequence([GO, GO, GO], [start, {}, {"v": 0.0}, target])


def objective(kind: str, seed: int, k_std: float, spread: bool) -> tuple[SequenceObjective, RefinementSettings]:
    chosen = RefinementSettings(
        horizon=9, k_std=k_std, arrival_spread=SPREAD if spread else (), p_fail_max=0.8, certify_checks=10_000
    )
    models = Models(
        {"goToPose/duration": Trees.random(seed, trees=3), "dribbleBall/duration": Trees.random(seed + 1, trees=1)},
        {"goToPose/success": Trees.random(seed + 2, trees=4, success=True)},
    )
    given_sequence = task(kind, seed)
    return SequenceObjective(given_sequence.actions, given_sequence.variables, models, chosen), chosen


def new_proof(
    kind: str, seed: int, k_std: float = 1.0, spread: bool = True, best: np.ndarray | None = None
) -> Certificate:
    cost, chosen = objective(kind, seed, k_std, spread)
    if best is None:
        solver = solver_for(cost, chosen, np.random.default_rng(seed), np.empty((0, cost.ranges.count)))
        solver.advance(CheckBudget(15))
        best = solver.best if solver.best is not None else cost.vector({})
    proof = certificate(cost, best, chosen)
    assert isinstance(proof, Certificate)
    return proof


@examples(12, 40)
def test_no_choice_costs_less_than_the_bound(count):
    @settings(max_examples=count, deadline=None)
    @given(kinds, seeds, st.sampled_from([0.0, 1.0, 2.0]), st.booleans())
    def holds(kind, seed, k_std, spread):
        proof = new_proof(kind, seed, k_std, spread)
        proof.advance(CheckBudget(25))
        cost, _ = objective(kind, seed, k_std, spread)
        drawn = cost.ranges.draw(4000, np.random.default_rng(seed))
        near = proof.best + 0.02 * cost.ranges.width * np.random.default_rng(seed).standard_normal(
            (1000, len(proof.best))
        )
        assert proof.bound <= cost(np.vstack([drawn, cost.ranges.confine(near)])).min()
        assert proof.bound <= proof.value

    holds()


@pytest.mark.parametrize("seed", range(8))
def test_one_subgoal_is_bounded_by_no_more_than_a_fine_grid_finds(seed):
    proof = new_proof("approach", seed)
    proof.advance(CheckBudget(150))
    cost, _ = objective("approach", seed, 1.0, True)
    axes = [np.linspace(lo, hi, 201) for lo, hi in zip(cost.ranges.lower, cost.ranges.upper, strict=True)]
    grid = cost(np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)).min()
    assert proof.bound <= min(grid, proof.value)
    if np.isfinite(grid):
        assert proof.bound > 0.9 * min(grid, proof.value)  # and by hardly less


@examples(8, 25)
def test_bound_never_falls_and_choice_never_gets_worse(count):
    @settings(max_examples=count, deadline=None)
    @given(kinds, seeds)
    def holds(kind, seed):
        proof = new_proof(kind, seed)
        bounds, values = [proof.bound], [proof.value]
        for _ in range(30):
            proof.advance(CheckBudget(1))
            bounds.append(proof.bound)
            values.append(proof.value)
        assert all(earlier <= later for earlier, later in pairwise(bounds))
        assert all(later <= earlier for earlier, later in pairwise(values))

    holds()


@examples(8, 25)
def test_slices_equal_one_run_with_the_same_checks(count):
    @settings(max_examples=count, deadline=None)
    @given(kinds, seeds, st.lists(st.integers(1, 8), min_size=1, max_size=6))
    def holds(kind, seed, slices):
        whole, sliced = new_proof(kind, seed), new_proof(kind, seed)
        whole.advance(CheckBudget(sum(slices)))
        for checks in slices:
            sliced.advance(CheckBudget(checks))
        assert (whole.bound, whole.value, whole.checks) == (sliced.bound, sliced.value, sliced.checks)
        assert np.array_equal(whole.best, sliced.best)

    holds()


def test_gap_that_is_good_enough_is_proven_for_one_subgoal_and_for_three():
    for kind in ("approach", "waypoints"):
        proof = new_proof(kind, 5, k_std=0.0, spread=False)
        proof.advance(CheckBudget(10_000))
        assert proof.finished
        assert proof.gap_pct <= 1.0 + 1e-9


def test_a_parameter_whose_range_is_a_point_neither_stops_a_proof_nor_is_split():
    start, target = {"x": -2.0, "y": 0.0, "phi": 0.0, "v": 0.0}, {"x": 0.0, "y": 1.5, "phi": 2.6, "v": 0.0}
    given_sequence = sequence([GO, GO], [start, {}, target])
    variables = tuple(
        replace(v, lower=0.0, upper=0.0) if v.free and v.unit == "m/s" else v for v in given_sequence.variables
    )
    models = Models({"goToPose/duration": Trees.random(0, trees=3)}, {})
    cost = SequenceObjective(given_sequence.actions, variables, models, RefinementSettings())
    assert (cost.ranges.width == 0).sum() == 1
    with np.errstate(all="raise"):
        proof = certificate(cost, cost.vector({}), RefinementSettings())
        proof.advance(CheckBudget(60))
    assert 0.8 * proof.value < proof.bound <= proof.value


def test_better_choice_than_the_given_one_is_found_on_the_way():
    cost, _ = objective("waypoints", 3, 1.0, True)
    worst = max(cost.ranges.draw(200, np.random.default_rng(0)), key=lambda one: cost(one[None])[0])
    proof = new_proof("waypoints", 3, best=worst)
    proof.advance(CheckBudget(60))
    assert proof.value < cost(worst[None])[0]
    assert proof.value == cost(proof.best[None])[0]
    assert within(cost.ranges, proof.best)


def test_proof_ends_when_its_checks_are_used_up():
    cost, chosen = objective("two places", 0, 1.0, True)
    proof = certificate(cost, cost.vector({}), replace(chosen, certify_checks=7))
    budget = CheckBudget(100)
    proof.advance(budget)
    assert proof.finished
    assert budget.granted == proof.checks == 7


@pytest.mark.parametrize("checks", [7, 300])
def test_an_abandoned_proof_is_freed_without_a_collection(checks):
    with gc_disabled():
        proof = new_proof("two places", 1)  # ends by itself within 300 checks
        proof.advance(CheckBudget(checks))
        held = weakref.ref(proof._proof)
        del proof
        assert held() is None


def test_proof_stagnates_only_if_its_bound_does_not_rise():
    stagnation, bounds = BoundStagnation(), [-np.inf, *np.linspace(1.0, 2.0, 100)]
    assert not any(stagnation.update(bound, 2.0) for bound in bounds)
    idle = [stagnation.update(2.0, 2.0) for _ in range(PATIENCE + 1)]
    assert idle == [False] * PATIENCE + [True]


def test_proof_that_would_spend_its_checks_on_its_first_boxes_is_not_begun(monkeypatch):
    monkeypatch.setattr("tailor.executive.refinement.certificates.proof.EFFORT", 1000)
    cost, chosen = objective("subgoal", 0, 1.0, True)
    proof = certificate(cost, cost.vector({}), replace(chosen, certify_checks=100))
    proof.advance(CheckBudget(100))
    assert proof.finished
    assert proof.checks < 10
    assert proof.gap_pct is None


def test_spent_budget_proves_nothing():
    proof = new_proof("approach", 0)
    proof.advance(CheckBudget(0))
    assert proof.gap_pct is None
    assert not proof.finished


def test_missing_bounds_are_reported_with_the_reason():
    given_sequence = approach_dribble()
    chosen = RefinementSettings()
    unknown = SequenceObjective(given_sequence.actions, given_sequence.variables, MODELS, chosen)
    refusal = certificate(unknown, unknown.vector({}), chosen)
    assert isinstance(refusal, NoBound)
    assert "have no bounds" in refusal.reason
    shifted = tuple(
        replace(action, action=replace(action.action, arguments=lambda values: values + 1.0))
        for action in given_sequence.actions
    )
    moved = SequenceObjective(shifted, given_sequence.variables, MODELS, chosen)
    assert "as intervals" in certificate(moved, moved.vector({}), chosen).reason
