"""Every solver finds the minimum of the classical benchmarks and of a brute-force grid."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.ranges import Ranges
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.chain import ChainSolver
from tailor.executive.refinement.solvers.chain_structure import blocks_of
from tailor.executive.refinement.solvers.differential import DifferentialEvolution
from tailor.executive.refinement.solvers.genetic import GeneticAlgorithm
from tailor.executive.refinement.solvers.selection import solver_for
from tailor.executive.refinement.solvers.solver import Limits
from tests.support.synthetic_models import APPROACH, GO, MODELS, approach_dribble, sequence


@dataclass
class Function:
    """A benchmark function as an objective of one stage."""

    ranges: Ranges
    function: Callable[[np.ndarray], np.ndarray]
    evaluations: int = 0

    @property
    def stages(self):
        return (self,)

    coarse_stages = stages

    @property
    def columns(self):
        return np.arange(self.ranges.count)

    def cost(self, samples):
        self.evaluations += len(samples)
        return self.function(samples)

    __call__ = cost

    def costs(self, stages, samples):
        return [stage.cost(own) for stage, own in zip(stages, samples, strict=True)]


def cube(half: float, count: int) -> Ranges:
    return Ranges(np.full(count, -half), np.full(count, half), np.zeros(count, dtype=bool))


def de_jong(x):
    return (x**2).sum(axis=1)


def schwefel(x):
    return 418.9828872724338 * x.shape[1] - (x * np.sin(np.sqrt(np.abs(x)))).sum(axis=1)


def ackley(x):
    squares = np.exp(-0.2 * np.sqrt((x**2).mean(axis=1)))
    return 20 + np.e - 20 * squares - np.exp(np.cos(2 * np.pi * x).mean(axis=1))


def solver(name: str, objective, seed: int = 1):
    rng, none = np.random.default_rng(seed), np.empty((0, objective.ranges.count))
    if name == "genetic":
        return GeneticAlgorithm(objective, rng, none)
    if name == "differential":
        return DifferentialEvolution(objective, rng, none, Limits(80, 800))
    return ChainSolver(objective, rng, none, 512, Limits(200, 800))


@pytest.mark.parametrize("name", ["genetic", "differential", "chain"])
@pytest.mark.parametrize(
    ("function", "half", "count", "close"),
    [(de_jong, 5.12, 3, 1e-3), (schwefel, 500.0, 3, 1.0), (ackley, 32.768, 3, 0.02)],
)
def test_benchmark_minimum_is_found(name, function, half, count, close):
    search = solver(name, Function(cube(half, count), function))
    search.advance(CheckBudget(10_000))
    assert search.finished
    assert -1e-9 <= search.value < close


@pytest.mark.parametrize("name", ["genetic", "differential", "chain"])
def test_solver_is_as_good_as_a_brute_force_grid(name):
    given = approach_dribble((1.5, -1.0, 1.0))
    settings = RefinementSettings(solver=name, arrival_spread=(), patience=60, worth_s=0.0)
    objective = SequenceObjective(given.within(2), given.variables, MODELS, settings)
    assert objective.ranges.count == 2
    axes = [np.linspace(lo, hi, 400) for lo, hi in zip(objective.ranges.lower, objective.ranges.upper, strict=True)]
    grid = objective(np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)).min()
    search = solver_for(objective, settings, np.random.default_rng(3), np.empty((0, 2)))
    search.advance(CheckBudget(10_000))
    assert search.value <= grid + 1e-6


@pytest.mark.parametrize("name", ["genetic", "differential", "chain"])
def test_nothing_valid_is_no_answer(name):
    search = solver(name, Function(cube(1.0, 2), lambda x: np.full(len(x), np.inf)))
    search.advance(CheckBudget(20))
    assert search.best is None
    assert search.value == np.inf


@pytest.mark.parametrize("name", ["genetic", "differential", "chain"])
def test_small_valid_region_is_found_from_a_seed(name):
    """A hundredth of a percent of the box is valid; the given start lies in it."""

    def pocket(x):
        away = np.abs(x - 0.5).max(axis=1)
        return np.where(away < 0.005, away, np.inf)

    objective, rng, seeds = Function(cube(1.0, 2), pocket), np.random.default_rng(0), np.array([[0.504, 0.504]])
    search = {
        "genetic": lambda: GeneticAlgorithm(objective, rng, seeds),
        "differential": lambda: DifferentialEvolution(objective, rng, seeds, Limits(80, 800)),
        "chain": lambda: ChainSolver(objective, rng, seeds, 512, Limits(200, 800)),
    }[name]()
    search.advance(CheckBudget(100))
    assert search.value <= 0.004 + 1e-9


def test_genetic_algorithm_has_25_chromosomes_a_parameter_and_stops_after_50_idle_generations():
    objective = Function(cube(1.0, 4), lambda x: np.zeros(len(x)))
    search = solver("genetic", objective)
    search.advance(CheckBudget(10_000))
    assert search.checks == 51  # the first one found a value
    assert objective.evaluations == 51 * 25 * 4


def test_genetic_algorithm_stops_after_500_generations():
    values = iter(range(10_000, 0, -1))
    search = solver("genetic", Function(cube(1.0, 1), lambda x: np.full(len(x), float(next(values)))))
    search.advance(CheckBudget(10_000))
    assert search.checks == 500


def test_subgoals_are_blocks_of_the_chain():
    place = {"x": 0.0, "y": 0.0}
    given = sequence([GO, APPROACH], [place | {"phi": 0.0, "v": 0.0}, place, place | {"phi": 0.0}])
    objective = SequenceObjective(given.actions, given.variables, MODELS, RefinementSettings())
    blocks = blocks_of(objective.stages)
    assert [block.tolist() for block in blocks] == [[0, 1], [2]]


def test_parameter_in_distant_actions_is_no_chain_and_falls_back_to_differential_evolution():
    given = approach_dribble()
    doubled = (*given.actions, given.actions[0])
    objective = SequenceObjective(doubled, given.variables, MODELS, RefinementSettings())
    assert blocks_of(objective.stages) is None
    chosen = solver_for(objective, RefinementSettings(solver="chain"), np.random.default_rng(0), np.empty((0, 2)))
    assert isinstance(chosen, DifferentialEvolution)


def test_search_ends_when_improvements_are_too_small():
    values = iter(1 + 0.5**k for k in range(10_000))
    objective = Function(cube(1.0, 1), lambda x: np.full(len(x), next(values)))
    none = np.empty((0, 1))
    eager = DifferentialEvolution(objective, np.random.default_rng(0), none, Limits(5, 1000, min_gain=0.1))
    eager.advance(CheckBudget(10_000))
    assert eager.finished
    assert eager.checks < 15


def test_the_elite_are_the_best_valid_half_of_a_population_and_none_before_the_first_check():
    def half_valid(x):
        return np.where(x[:, 0] > 0.0, de_jong(x), np.inf)

    objective = Function(cube(5.0, 2), half_valid)
    search = DifferentialEvolution(objective, np.random.default_rng(0), np.empty((0, 2)), Limits(2, 2))
    assert search.elite.shape == (0, 2)
    search.advance(CheckBudget(1))
    costs = half_valid(search.elite)
    assert 2 < len(costs) <= 12
    assert np.isfinite(costs).all()
    assert (np.diff(costs) >= 0.0).all()
    assert costs[0] == search.value
    never = Function(cube(5.0, 2), lambda x: np.full(len(x), np.inf))
    search = DifferentialEvolution(never, np.random.default_rng(0), np.empty((0, 2)), Limits(2, 2))
    search.advance(CheckBudget(1))
    assert search.elite.shape == (0, 2)


def test_every_solver_keeps_the_limit_of_checks():
    """Subgoals are compared with few checks: a solver that took 500 for each would hold up the decision."""
    for name in ("chain", "genetic", "differential"):
        settings = RefinementSettings(solver=name, checks_max=7)
        objective = SequenceObjective(approach_dribble().within(2), approach_dribble().variables, MODELS, settings)
        search = solver_for(objective, settings, np.random.default_rng(0), np.empty((0, objective.ranges.count)))
        search.advance(CheckBudget(100))
        assert (search.finished, search.checks) == (True, 7), name
