"""Bounds of actions with the models that ship: no values in a pair of boxes cost less, however wide or narrow."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.certificates.boxes import NO_PARAMETERS, Boxes, box_of
from tailor.executive.refinement.certificates.certificate import Certificate, certificate
from tailor.executive.refinement.certificates.joint_bounds import joint_bounds
from tailor.executive.refinement.certificates.stage_bounds import StageBound, stage_bound
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.chain_structure import blocks_of, links_of
from tailor.executive.refinement.solvers.selection import solver_for
from tailor.models.runtime import load_robot
from tailor.tools.benchmarks.refinement.cases import Case, cases
from tailor.tools.benchmarks.refinement.decisions import first_decision

TASKS = 2


@pytest.fixture(scope="module")
def models() -> Models:
    return Models(*load_robot("agilo"))


@pytest.fixture(scope="module")
def drawn(models) -> dict[str, list[Case]]:
    """Drawn once: before a subgoal is asserted, many approaches are tried."""
    return cases(models, TASKS)


@pytest.fixture(scope="module")
def tasks(drawn) -> list[Case]:
    return [task for name in ("2 free", "4 free", "5 free, subgoal") for task in drawn[name]]


def drawn_boxes(ranges, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Ends of a box anywhere in the ranges, each side from a hundred-thousandth to all of its range, or a point."""
    centre = ranges.draw(1, rng)[0]
    half = ranges.width * 10.0 ** rng.uniform(-5, 0, ranges.count) * rng.choice([0.0, 0.5, 0.5], ranges.count)
    return np.clip(centre - half, ranges.lower, ranges.upper), np.clip(centre + half, ranges.lower, ranges.upper)


def assert_no_stage_costs_less(cost, chosen, lower, upper, inside) -> None:
    """Each stage's bound over a box, `lower` to `upper`, is at most its cost at every point inside."""
    blocks = blocks_of(cost.stages)
    assert blocks is not None
    whole, before = NO_PARAMETERS, NO_PARAMETERS
    for stage, link, block in zip(cost.stages, links_of(cost.stages, blocks), blocks, strict=True):
        everywhere, own = box_of(cost.ranges.part(block)), Boxes(lower[None, block], upper[None, block])
        bound = stage_bound(stage, link, chosen)
        assert isinstance(bound, StageBound)
        (bounds,) = joint_bounds([(bound.within(whole, everywhere), before, own)])
        cost_inside = stage.cost(inside[:, stage.columns])
        samples = inside[:, stage.columns]
        first, second = np.zeros((len(inside), before.lower.shape[1])), np.zeros((len(inside), own.lower.shape[1]))
        first[:, link.before], second[:, link.own] = samples[:, link.from_before], samples[:, ~link.from_before]
        linear = bounds.middle[0]
        if bounds.slopes is not None:
            slopes = [slope[0] for slope in bounds.slopes]
            linear = linear + (first - before.middle) @ slopes[0] + (second - own.middle) @ slopes[1]
        assert (linear <= cost_inside).all()
        whole, before = everywhere, own


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 3 * TASKS - 1), st.integers(0, 2**32 - 1), st.sampled_from([0.0, 0.5, 1.0, 2.0]), st.booleans())
def test_no_values_in_a_pair_of_boxes_cost_less_than_its_bound(models, tasks, task, seed, k_std, exact):
    rng = np.random.default_rng(seed)
    chosen = replace(RefinementSettings(), k_std=k_std, **({"arrival_spread": ()} if exact else {}))
    cost = tasks[task].objective(models, chosen)
    lower, upper = drawn_boxes(cost.ranges, rng)
    share = rng.choice([0.0, 1.0, 0.5, np.nan], (400, cost.ranges.count))
    inside = lower + np.where(np.isnan(share), rng.random(share.shape), share) * (upper - lower)
    assert_no_stage_costs_less(cost, chosen, lower, upper, inside)


@pytest.fixture(scope="module")
def fetching() -> SequenceObjective:
    """The first two actions of a fetched cup: a drive beside all furniture, and the grip."""
    pytest.importorskip("pybullet")
    models, case = first_decision("kitchen", "one-cup", 3)
    drive, grip = case.actions[:2]
    assert len(drive.context) > 10
    return SequenceObjective((drive, grip), case.variables, models, RefinementSettings())


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_no_values_cost_less_than_a_bound_that_ignores_furniture(fetching, seed):
    rng = np.random.default_rng(seed)
    lower, upper = drawn_boxes(fetching.ranges, rng)
    inside = lower + rng.random((400, fetching.ranges.count)) * (upper - lower)
    assert_no_stage_costs_less(fetching, RefinementSettings(), lower, upper, inside)


def test_a_drive_beside_furniture_and_a_grip_are_certified_within_three_percent(fetching):
    _, proof = searched_and_proven(fetching, RefinementSettings())
    assert proof.gap_pct is not None
    assert proof.gap_pct < 3.0


def searched_and_proven(cost, chosen, checks: int = 45) -> tuple[Any, Certificate]:
    solver = solver_for(cost, chosen, np.random.default_rng(0), np.empty((0, cost.ranges.count)))
    solver.advance(CheckBudget(25))
    assert solver.best is not None
    proof = certificate(cost, solver.best, chosen)
    assert isinstance(proof, Certificate)
    proof.advance(CheckBudget(checks))
    return solver, proof


def test_slopes_of_neighbouring_actions_cancel_so_that_four_subgoals_are_certified_in_few_checks(models, drawn):
    chosen = replace(RefinementSettings(), certify_gap_pct=5.0)
    cost = drawn["8 free"][1].objective(models, chosen)
    _, proof = searched_and_proven(cost, chosen)
    assert proof.gap_pct is not None
    assert proof.gap_pct <= 5.0 + 1e-9


def relative_gaps(models, tasks, spread: float) -> np.ndarray:
    """Share of the cost of single choices by which the bounds are lower, with this multiple of the arrivals' spread."""
    plain = RefinementSettings()
    arrivals = tuple((quantity, spread * std) for quantity, std in plain.arrival_spread) if spread else ()
    chosen, gaps = replace(plain, arrival_spread=arrivals), []
    for task in tasks:
        cost = task.objective(models, chosen)
        blocks = blocks_of(cost.stages)
        assert blocks is not None
        links = links_of(cost.stages, blocks)
        bounds = [stage_bound(stage, link, chosen) for stage, link in zip(cost.stages, links, strict=True)]
        for choice in cost.ranges.draw(10, np.random.default_rng(0)):
            points = [Boxes(choice[None, block], choice[None, block]) for block in blocks]
            pairs = zip(bounds, [NO_PARAMETERS, *points], points, strict=False)
            least = sum(bounds.middle[0] for bounds in joint_bounds(list(pairs)))
            gaps.append(1 - least / cost(choice[None])[0])
    return np.array(gaps)


def test_stages_bound_a_single_choice_as_tightly_as_any_model_permits(models, tasks):
    """With exact arrivals a choice is a point, where only what single precision may round is lost.

    Arrivals that spread are bounded by one linear function, whose error is the model's curvature: of second order in
    the spread, so that half the spread leaves a quarter of it. How curved the models are is not judged, nor are the few
    choices at a jump of a model, such as that of an angle at half a turn.
    """
    linear = tasks[: 2 * TASKS]
    exact, half, whole = (relative_gaps(models, linear, spread) for spread in (0.0, 0.5, 1.0))
    assert np.median(exact) < 0.0005
    assert np.median(half - exact) < 0.4 * np.median(whole - exact)


@pytest.mark.parametrize("seed", range(3))
def test_actions_bounded_in_one_call_have_the_bounds_of_each_alone(models, drawn, seed):
    rng = np.random.default_rng(seed)
    cost = drawn["8 free"][0].objective(models, RefinementSettings())
    blocks = blocks_of(cost.stages)
    assert blocks is not None
    boxes = [NO_PARAMETERS.part(np.zeros(3, np.intp))]
    for block in blocks:
        each = [drawn_boxes(cost.ranges.part(block), rng) for _ in range(3)]
        boxes.append(Boxes(*(np.array(ends) for ends in zip(*each, strict=True))))
    bounds = [
        stage_bound(stage, link, RefinementSettings())
        for stage, link in zip(cost.stages, links_of(cost.stages, blocks), strict=True)
    ]
    requests = list(zip(bounds, boxes, boxes[1:], strict=False))
    alone = [joint_bounds([request])[0] for request in requests]
    for one, other in zip(joint_bounds(requests), alone, strict=True):
        assert np.allclose(one.middle, other.middle, rtol=1e-5)
        for slopes in zip(one.slopes or (), other.slopes or (), strict=True):
            assert np.allclose(*slopes, atol=1e-4)


@pytest.mark.parametrize("task", range(TASKS))
def test_no_choice_costs_less_than_a_proof_with_models_that_ship_states(models, drawn, task):
    chosen = replace(RefinementSettings(), certify_gap_pct=5.0)
    cost = drawn["8 free"][task].objective(models, chosen)
    solver, proof = searched_and_proven(cost, chosen, chosen.certify_checks)
    rng = np.random.default_rng(task)
    near = solver.best + 0.02 * cost.ranges.width * rng.standard_normal((2000, cost.ranges.count))
    assert 0.9 * solver.value < proof.bound
    assert proof.bound <= cost(np.vstack([cost.ranges.draw(2000, rng), cost.ranges.confine(near)])).min()
