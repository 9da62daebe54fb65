"""The check whether an action can succeed keeps the best of all that it has drawn."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.refinement.assertion import feasibility_check
from tailor.executive.refinement.objective.settings import RefinementSettings

RARE, ELSE = 0.3, 0.9  # failure within a thousandth of the middle, and everywhere else


class RarelyGood:
    """An objective of one parameter between 0 and 1."""

    ids = (0,)

    def __init__(self, *_: Any) -> None:
        self.stages = [self]
        self.ranges = SimpleNamespace(draw=lambda count, rng: rng.random((count, 1)))

    def predict(self, samples):
        failure = np.where(np.abs(samples[:, 0] - 0.5) < 1e-3, RARE, ELSE)
        return SimpleNamespace(worst_failure=failure, duration_s=np.ones(len(failure)))

    def values(self, sample):
        return {0: float(sample[0])}

    def vectors(self, starts):
        return np.array([[start[0]] for start in starts]).reshape(-1, 1)


def test_the_start_of_the_least_failure_is_kept_over_all_batches(monkeypatch):
    monkeypatch.setattr(feasibility_check, "SequenceObjective", RarelyGood)
    given = cast("Any", SimpleNamespace(actions=[SimpleNamespace(risk=None, variables=())], variables=(), starts=()))
    found = 0
    for seed in range(20):
        rng = np.random.default_rng(seed)
        check = feasibility_check.FeasibilityCheck(given, 0, cast("Any", None), RefinementSettings(), rng)
        assert check.advance(CheckBudget(100)) is False, "even the best is beyond the limit"
        found += check.best_failure == RARE
        good = [abs(start[0] - 0.5) < 1e-3 for start in check.starts]
        assert all(good) if check.best_failure == RARE else not any(good)
        assert check.starts
    assert found > 10


@pytest.mark.parametrize(("starts", "kept"), [((0.9, 0.5, 0.2, 0.5004), [0.5, 0.5004]), ((0.9, 0.2), [])])
def test_candidates_of_an_earlier_search_within_the_limit_spare_the_draws(monkeypatch, starts, kept):
    monkeypatch.setattr(feasibility_check, "SequenceObjective", RarelyGood)
    action, known = SimpleNamespace(risk=0.5, variables=()), [*({0: each} for each in starts), {7: 0.5}]
    given = cast("Any", SimpleNamespace(actions=[action], variables=(), starts=known))
    settings = RefinementSettings(assertion_samples=1)
    check = feasibility_check.FeasibilityCheck(given, 0, cast("Any", None), settings, np.random.default_rng(0))
    assert check.advance(CheckBudget(1)) is (True if kept else None)
    assert [start[0] for start in check.starts] == kept
