"""The wide search finds the basin of the best subgoal, and assertion hands its candidates on to refinement."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.refinement.assertion.assertion import Assertion
from tailor.executive.refinement.assertion.wide_search import GENERATIONS, N_BEST, WideSearch
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.ranges import Ranges
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.differential import DifferentialEvolution
from tailor.executive.refinement.solvers.solver import Limits
from tests.unit.executive.refinement.synthetic_context import BESIDE, GO_AROUND, beside

BROAD, NARROW = np.full(4, 0.7), np.full(4, 0.25)
START = {"x": -2.0, "y": 0.0, "phi": 0.0, "v": 0.0}
GOAL = {"x": 2.0, "y": 0.0, "phi": 0.0, "v": 0.0}


class TwoBasins:
    """Cost of four parameters between 0 and 1: a broad basin, and a narrow one that is deeper by 1 s."""

    ids = (0, 1, 2, 3)
    evaluations = 0
    ranges = Ranges(np.zeros(4), np.ones(4), np.zeros(4, bool))
    coarse_stages = (SimpleNamespace(columns=np.arange(4)),)

    def __call__(self, candidates):
        broad, narrow = (np.linalg.norm(candidates - middle, axis=1) for middle in (BROAD, NARROW))
        return np.minimum(1.0 + broad, 6.0 * narrow)

    def costs(self, stages, samples):
        return [self(samples[0])]


def test_narrow_basin_is_found_where_a_quick_search_settles_in_the_broad_one():
    objective, wide, quick = cast("Any", TwoBasins()), 0, 0
    for seed in range(20):
        search = WideSearch(objective, np.random.default_rng(seed))
        assert search.advance(CheckBudget(GENERATIONS))
        wide += np.linalg.norm(search.best[0] - NARROW) < 0.1
        small = DifferentialEvolution(objective, np.random.default_rng(seed), np.empty((0, 4)), Limits(100, 100))
        small.advance(CheckBudget(100))
        quick += np.linalg.norm(small.best - NARROW) < 0.1
    assert wide >= 17
    assert quick <= 10


def test_slices_give_what_one_run_gives():
    sliced, whole = (WideSearch(cast("Any", TwoBasins()), np.random.default_rng(0)) for _ in range(2))
    assert [sliced.advance(CheckBudget(1)) for _ in range(GENERATIONS)] == [False] * (GENERATIONS - 1) + [True]
    assert whole.advance(CheckBudget(GENERATIONS))
    np.testing.assert_array_equal(sliced.best, whole.best)
    assert len(whole.best) == N_BEST


def test_refinement_begins_with_a_subgoal_that_is_hardly_worse_than_the_best():
    settings = RefinementSettings()
    sequence = beside(((0.0, 0.0, 0.3),), [GO_AROUND], [START, GOAL])
    asserted = Assertion(sequence, BESIDE, settings, np.random.default_rng(0)).advance(CheckBudget(1000))
    assert asserted.actions[0].asserted
    objective = SequenceObjective(asserted.actions, asserted.variables, BESIDE, settings)
    search = DifferentialEvolution(
        objective, np.random.default_rng(1), np.empty((0, len(objective.ids))), Limits(200, 200)
    )
    search.advance(CheckBudget(200))
    assert min(objective(objective.vectors(asserted.starts))) < 1.03 * search.value
