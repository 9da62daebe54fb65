"""The comparison of a way with a subgoal: among objects it waits for the wide search, and begins with its best."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.refinement.assertion import subgoal_comparison as module
from tailor.executive.refinement.assertion.asserted_subgoal import with_subgoal
from tailor.executive.refinement.assertion.subgoal_comparison import SubgoalComparison
from tailor.executive.refinement.objective.settings import RefinementSettings
from tests.unit.executive.refinement.synthetic_context import BESIDE, GO_AROUND, beside

START = {"x": -2.0, "y": 0.0, "phi": 0.0, "v": 0.0}
GOAL = {"x": 2.0, "y": 0.0, "phi": 0.0, "v": 0.0}
FOUND = np.array([[0.25, 1.0, 0.1, 0.2], [0.5, -1.0, 0.0, 0.1]])
WAITS = 3  # portions of the wide search


class Wide:
    """A wide search that takes some portions, and finds what it is told."""

    begun = 0

    def __init__(self, objective, rng):
        Wide.begun += 1
        self.portions, self.best = 0, FOUND

    def advance(self, budget):
        self.portions += not budget.spent()
        return self.portions > WAITS


@pytest.fixture
def begun(monkeypatch):
    """Starts of both searches, in the order in which they begin."""
    Wide.begun, starts, solver_for = 0, [], module.solver_for

    def noting(objective, settings, rng, seeds):
        starts.append(seeds.tolist())
        return solver_for(objective, settings, rng, seeds)

    monkeypatch.setattr(module, "WideSearch", Wide)
    monkeypatch.setattr(module, "solver_for", noting)
    return starts


def comparison(*discs):
    direct = beside(discs, [GO_AROUND], [START, GOAL])
    settings = replace(RefinementSettings(), comparison_checks=3)
    return SubgoalComparison(direct, with_subgoal(direct, 0), 0, BESIDE, settings, np.random.default_rng(0))


def test_among_objects_both_searches_wait_for_the_wide_one_and_that_of_the_subgoal_begins_with_its_best(begun):
    compared = comparison((0.0, 0.0, 0.3))
    assert [compared.advance(CheckBudget(1)) for _ in range(WAITS)] == [None] * WAITS
    assert not begun
    assert compared.advance(CheckBudget(100)) is True
    direct, around = begun
    assert around[-len(FOUND) :] == FOUND.tolist()
    assert not any(each in direct for each in FOUND.tolist())
    values = [list(start.values()) for start in compared.starts]
    assert values[-len(FOUND) :] == FOUND.tolist(), "they are starts of the decision, too"
    assert len(values) > len(FOUND)


def test_without_objects_nothing_is_searched_widely(begun):
    compared = comparison()
    compared.advance(CheckBudget(1))
    assert (Wide.begun, len(begun)) == (0, 2)
