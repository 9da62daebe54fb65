"""Trains the refinement gate (paper 6.3.2) on paired episodes: whether refinement cost time, from both predictions.

A pair is one start, run greedy and refined with the same noise. All reported scores are cross-validated.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.models.features.features import FeatureSpace, Quantity
from tailor.models.rules.rule_text import success_rules
from tailor.models.training.gate_trees import LEARNERS, RiskTrees, grow_tree
from tailor.schemas.errors import UsageError

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

MIN_PAIRS = 100  # fewer do not determine a few in a hundred
FOLDS = 8
THRESHOLDS = tuple(round(0.1 + 0.0125 * k, 4) for k in range(41))  # 0.1 .. 0.6
MAX_GAIN = 0.1  # of greedy's time; larger gains and losses are clipped, for they come from the ball's luck
BASE_STAKE = 0.005
PRICE_PCT = 0.1  # percentage points of improvement to give up for fewer slower episodes


@dataclass(frozen=True, slots=True)
class Pairs:
    """n starts that reached their goal both ways.

    Attributes:
      situations: Features of the two choices, shape (n, k).
      greedy_s: Duration of the greedy run, seconds, shape (n,).
      refined_s: Duration of the refined run, seconds, shape (n,).
    """

    situations: Array
    greedy_s: Array
    refined_s: Array

    @property
    def slower(self) -> Bools:
        """Whether refinement was slower, shape (n,)."""
        return self.refined_s > self.greedy_s

    @property
    def gain(self) -> Array:
        """Gain of refinement as a share of greedy's time, clipped, shape (n,)."""
        return np.clip(1 - self.refined_s / self.greedy_s, -MAX_GAIN, MAX_GAIN)

    def grown(self, learner: str, chosen: Bools, seed: int) -> RiskTrees:
        """Trees fitted to the chosen pairs, (n,)."""
        stakes = np.abs(self.gain[chosen]) + BASE_STAKE
        return LEARNERS[learner](self.situations[chosen], self.slower[chosen], stakes, np.random.default_rng(seed))


@dataclass(frozen=True, slots=True)
class TrainedGate:
    """Trees fitted to all pairs, the risk above which greedy is kept, and cross-validated scores."""

    trees: RiskTrees
    threshold: float
    test: Mapping[str, Any]
    rules: tuple[str, ...]  # of one tree of four rules that approximates the trees


def space(names: tuple[str, ...]) -> FeatureSpace:
    """Feature space of situations, unchanged; a name ends in its unit."""
    units = {"s": "s", "pct": "%", "rad": "rad"}
    quantities = tuple(Quantity(name, units.get(name.rpartition("_")[2], "")) for name in names)
    return FeatureSpace("situation", quantities, quantities, lambda columns, _: columns)


def train_gate(
    pairs: Pairs, names: tuple[str, ...], learner: str, seed: int, price_pct: float = PRICE_PCT
) -> TrainedGate:
    """Train the gate; the same pairs and seed give the same trees.

    Args:
      pairs: Pairs of training seeds.
      names: Names of the columns of the situations.
      learner: Key of `LEARNERS`.
      seed: Random seed of folds and trees.
      price_pct: Percentage points of improvement to give up for fewer slower episodes, see `chosen`.

    Raises:
      UsageError: Too few pairs, all with the same result, or an unknown learner.
    """
    check_learner(learner, len(pairs.slower))
    if len(np.unique(pairs.slower)) < 2:
        raise UsageError("refinement had the same result in all pairs, expected some slower and some not")
    unseen = _cross_validated_risk(pairs, learner, seed)
    curve = [judged(pairs, unseen > threshold, threshold) for threshold in THRESHOLDS]
    best = chosen(curve, price_pct)
    everything = np.ones_like(pairs.slower)
    ungated = judged(pairs, ~everything, 1.0)
    test = {**best, "ungated": ungated, "perfect": judged(pairs, pairs.slower, 0.0), "curve": curve}
    return TrainedGate(pairs.grown(learner, everything, seed), best["threshold"], test, _rules(pairs, names))


def check_learner(learner: str, pairs: int) -> None:
    """Check the name of a learner and the number of pairs.

    Raises:
      UsageError: There is no such learner, or there are fewer than MIN_PAIRS pairs.
    """
    if learner not in LEARNERS:
        raise UsageError(
            f"learner '{learner}' is unknown for the refinement gate (expected one of: {', '.join(LEARNERS)})"
        )
    if pairs < MIN_PAIRS:
        raise UsageError(f"{pairs} pairs of episodes, expected at least {MIN_PAIRS}")


def chosen(curve: list[dict[str, Any]], price_pct: float) -> dict[str, Any]:
    """The row with the fewest slower episodes that costs at most `price_pct` points of clipped improvement."""
    affordable = [row for row in curve if row["price_pct"] <= price_pct] or curve[-1:]
    return min(affordable, key=lambda row: (row["slower_pct"], row["price_pct"]))


def judged(pairs: Pairs, kept: Bools, threshold: float) -> dict[str, Any]:
    """Scores of keeping the greedy choice where `kept`, shape (n,)."""
    slower = pairs.slower
    taken_s = np.where(kept, pairs.greedy_s, pairs.refined_s)
    confusion = [[int(np.sum((slower == was) & (kept == keep))) for keep in (False, True)] for was in (False, True)]
    return {
        "threshold": threshold,
        "n": len(slower),
        "right_pct": 100 * float(np.mean(kept == slower)),
        "kept_pct": 100 * float(kept.mean()),
        "improvement_pct": 100 * float(np.mean(1 - taken_s / pairs.greedy_s)),
        "price_pct": 100 * float(np.mean(np.where(kept, pairs.gain, 0.0))),
        "slower_pct": 100 * float(np.mean(taken_s > pairs.greedy_s)),
        "confusion": confusion,  # rows: refinement was not slower, was slower; columns: refined, greedy kept
    }


def _cross_validated_risk(pairs: Pairs, learner: str, seed: int) -> Array:
    """Risk of each pair, shape (n,), predicted by trees fitted without its fold."""
    fold = np.random.default_rng(seed).permutation(len(pairs.slower)) % FOLDS
    risk = np.empty(len(fold))
    for k in range(FOLDS):
        risk[fold == k] = pairs.grown(learner, fold != k, seed).risk(pairs.situations[fold == k])
    return risk


def _rules(pairs: Pairs, names: tuple[str, ...]) -> tuple[str, ...]:
    stakes = np.abs(pairs.gain) + BASE_STAKE
    ((splits, shares),) = grow_tree(pairs.situations, pairs.slower, stakes, np.random.default_rng(0)).steps
    rules = success_rules(splits, shares, space(names).features)
    return tuple(rule.replace("then success in", "then refining risks") for rule in rules)
