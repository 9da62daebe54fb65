"""The analytic solver finds the optimum of model trees exactly, and says when a case is not of that kind."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.analytic import AnalyticSolver
from tailor.executive.refinement.solvers.breakpoints import NotAnalytic, TreeEdges, breakpoints
from tailor.executive.refinement.solvers.chain import ChainSolver
from tailor.executive.refinement.solvers.solver import Limits
from tests.support.synthetic_models import GO, norm, sequence

FEATURES = ("v", "v_g", "dist", "angle_to", "angle_at")
PLAIN = RefinementSettings(horizon=9, k_std=0.0, arrival_spread=())


def features(arguments: Array) -> Array:
    x, y, phi, v, xg, yg, phig, vg = arguments.T
    sight = np.arctan2(yg - y, xg - x)
    to = norm(sight - phi)
    at = np.where(to < 0, -1.0, 1.0) * norm(phig - sight)
    return np.column_stack([v, vg, np.hypot(xg - x, yg - y), np.abs(to), at])


@dataclass
class PlaneGrid:
    """Planes over boxes of the feature space, cut at random thresholds: what any model tree can be brought to."""

    thresholds: dict[str, Array]
    slopes: Array
    heights: Array

    @classmethod
    def random(cls, seed: int) -> PlaneGrid:
        rng = np.random.default_rng(seed)
        ranges = {"v": (0, 0.75), "v_g": (0, 0.75), "dist": (0, 5), "angle_to": (0, np.pi), "angle_at": (-np.pi, np.pi)}
        cuts = {name: np.sort(rng.uniform(*ranges[name], 2)) for name in FEATURES}
        return cls(cuts, rng.normal(0, 1, (3,) * 5 + (5,)), rng.uniform(5, 8, (3,) * 5))

    def predict(self, arguments: Array) -> tuple[Array, Array]:
        given = features(arguments)
        cell = tuple(np.searchsorted(self.thresholds[name], given[:, k]) for k, name in enumerate(FEATURES))
        seconds = self.heights[cell] + (self.slopes[cell] * given).sum(axis=1)
        return seconds, np.zeros(len(seconds))


def legs(count: int, seed: int):
    rng = np.random.default_rng([seed, count])
    places = [{"x": rng.uniform(-3, 3), "y": rng.uniform(-2, 2)} for _ in range(count + 1)]
    places[0] |= {"phi": 0.3, "v": 0.1}
    places[-1] |= {"phi": -1.0, "v": 0.0}
    return sequence([GO] * count, places)


def solved(count: int, seed: int) -> tuple[AnalyticSolver, SequenceObjective]:
    model, given = PlaneGrid.random(seed), legs(count, seed)
    objective = SequenceObjective(given.actions, given.variables, Models({"goToPose/duration": model}, {}), PLAIN)
    edges = {"goToPose": TreeEdges({name: tuple(cuts) for name, cuts in model.thresholds.items()})}
    points = breakpoints(given.actions, given.variables, objective, edges, PLAIN)
    assert not isinstance(points, NotAnalytic)
    solver = AnalyticSolver(objective, points)
    solver.advance(CheckBudget(100))
    assert solver.finished
    return solver, objective


@pytest.mark.parametrize("seed", range(6))
def test_one_subgoal_is_no_worse_than_a_fine_grid(seed):
    solver, objective = solved(2, seed)
    axes = [np.linspace(lo, hi, 700) for lo, hi in zip(objective.ranges.lower, objective.ranges.upper, strict=True)]
    grid = objective(np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)).min()
    assert solver.value <= grid + 1e-4
    assert solver.value > grid - 0.1
    assert objective(solver.best[None])[0] == pytest.approx(solver.value)


@pytest.mark.parametrize("seed", range(3))
def test_chain_of_subgoals_is_no_worse_than_a_long_search(seed):
    solver, objective = solved(3, seed)
    search = ChainSolver(objective, np.random.default_rng(1), np.empty((0, 4)), 256, Limits(400, 2000))
    search.advance(CheckBudget(2000))
    assert solver.value <= search.value + 1e-4


def refusal(given, settings=PLAIN, edges=None) -> str:
    models = Models({"goToPose/duration": PlaneGrid.random(0)}, {})
    objective = SequenceObjective(given.actions, given.variables, models, settings)
    said = breakpoints(given.actions, given.variables, objective, edges or {"goToPose": TreeEdges({})}, settings)
    assert isinstance(said, NotAnalytic)
    return said.reason


def test_case_that_is_not_of_the_kind_is_told_plainly():
    two = legs(2, 0)
    free_place = sequence([GO, GO], [{"x": 0.0, "y": 0.0}, {"x": 1.0}, {"x": 2.0, "y": 0.0}])
    shifted = tuple(
        replace(action, action=replace(GO, arguments=lambda values: values + 1.0)) for action in two.actions
    )
    assert "spread" in refusal(two, RefinementSettings(k_std=1.0))
    assert "arrivals" in refusal(two, replace(PLAIN, arrival_spread=(("x", 0.1),)))
    assert "clipped" in refusal(two, edges={"goToPose": TreeEdges({}, clipped=True)})
    assert "no tree" in refusal(two, edges={"reach": TreeEdges({})})
    assert "yg is free" in refusal(free_place)
    assert "as they are" in refusal(replace(two, actions=shifted))
