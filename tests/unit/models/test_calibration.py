"""Intervals are calibrated where the optimiser goes as soon as enough of its choices are known."""

import numpy as np
import pytest

from tailor.models.training import scores
from tailor.models.training.calibration import MIN_POLICY_EPISODES, calibrated


def errors(count: int, deviation: float, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).normal(0.0, deviation, count)


def test_random_episodes_alone_hold_nine_in_ten_of_their_errors() -> None:
    off = errors(2000, 0.5, 1)
    entries = calibrated(off, np.full(2000, 0.5), np.zeros(2000, bool))
    assert entries["interval90_on"] == "random"
    assert entries["interval90_factor"] == pytest.approx(1.645, abs=0.1)
    assert "interval90_random_factor" not in entries


def test_on_policy_errors_that_are_larger_widen_the_interval_and_the_card_says_by_how_much() -> None:
    off = np.concatenate([errors(2000, 0.5, 1), errors(400, 1.0, 2)])
    on_policy = np.arange(2400) >= 2000
    std = np.full(2400, 0.5)
    entries = calibrated(off, std, on_policy)
    assert (entries["interval90_on"], entries["interval90_n"]) == ("on-policy", 400)
    assert entries["interval90_factor"] > 1.8 * entries["interval90_random_factor"]
    assert entries["interval90_random_covers_pct"] < 70
    assert scores.coverage(off[on_policy], std[on_policy], entries["interval90_factor"]) == pytest.approx(90, abs=1)


def test_a_few_on_policy_episodes_decide_nothing() -> None:
    on_policy = np.arange(500) < MIN_POLICY_EPISODES - 1
    assert calibrated(errors(500, 0.5, 3), np.full(500, 0.5), on_policy)["interval90_on"] == "random"
    assert calibrated(errors(20, 0.5, 3), np.full(20, 0.5), np.ones(20, bool))["interval90_on"] == "on-policy"
