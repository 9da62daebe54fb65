"""Learns when not to refine (paper 6.3.2): from paired episodes, whether refining cost time, by what both choices say.

A pair is one start run twice with the same noise, greedy and refined. Everything that the card reports was said by
twins that had not seen the pair.
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

MIN_PAIRS = 100  # pairs: fewer say nothing about a few in a hundred
FOLDS = 8
THRESHOLDS = tuple(round(0.1 + 0.0125 * k, 4) for k in range(41))  # 0.1 .. 0.6
CLIP = 0.1  # a pair counts by its gain or loss, as a share of greedy's time, up to this: ball luck is worth no more
BASE_STAKE = 0.005
PRICE_PCT = 0.1  # of improvement, in points, that fewer slower episodes may cost


@dataclass(frozen=True, slots=True)
class Pairs:
    """n starts that reached their goal both ways."""

    situations: Array  # (n, k), how the two choices differ
    greedy_s: Array  # (n,)
    refined_s: Array  # (n,)

    @property
    def slower(self) -> Bools:
        """Whether refining cost time, shape (n,)."""
        return self.refined_s > self.greedy_s

    @property
    def gain(self) -> Array:
        """What refining gained, clipped, as a share of greedy's time, shape (n,)."""
        return np.clip(1 - self.refined_s / self.greedy_s, -CLIP, CLIP)

    def grown(self, learner: str, chosen: Bools, seed: int) -> RiskTrees:
        """Trees learned from the chosen pairs, (n,)."""
        stakes = np.abs(self.gain[chosen]) + BASE_STAKE
        return LEARNERS[learner](self.situations[chosen], self.slower[chosen], stakes, np.random.default_rng(seed))


@dataclass(frozen=True, slots=True)
class TrainedGate:
    """Trees learned from all pairs, the risk above which greedy is kept, and what their twins reached."""

    trees: RiskTrees
    threshold: float
    test: Mapping[str, Any]
    rules: tuple[str, ...]  # of one tree of four rules that says much the same


def space(names: tuple[str, ...]) -> FeatureSpace:
    """Situations as they are told; a name ends in its unit."""
    units = {"s": "s", "pct": "%", "rad": "rad"}
    quantities = tuple(Quantity(name, units.get(name.rpartition("_")[2], "")) for name in names)
    return FeatureSpace("situation", quantities, quantities, lambda columns, _: columns)


def train_gate(
    pairs: Pairs, names: tuple[str, ...], learner: str, seed: int, price_pct: float = PRICE_PCT
) -> TrainedGate:
    """Learn from pairs; the same pairs and seed give the same trees.

    Args:
      pairs: Of training seeds.
      names: Of the columns of the situations.
      learner: One of LEARNERS.
      seed: Draws folds and what the learner draws.
      price_pct: Points of improvement that fewer slower episodes may cost, see `chosen`.

    Raises:
      UsageError: Too few pairs, pairs that all ended alike, or an unknown learner.
    """
    check_learner(learner, len(pairs.slower))
    if len(np.unique(pairs.slower)) < 2:
        raise UsageError("refining ended alike in all pairs, expected some slower and some not")
    unseen = _said_by_twins(pairs, learner, seed)
    curve = [judged(pairs, unseen > threshold, threshold) for threshold in THRESHOLDS]
    best = chosen(curve, price_pct)
    everything = np.ones_like(pairs.slower)
    ungated = judged(pairs, ~everything, 1.0)
    test = {**best, "ungated": ungated, "perfect": judged(pairs, pairs.slower, 0.0), "curve": curve}
    return TrainedGate(pairs.grown(learner, everything, seed), best["threshold"], test, _rules(pairs, names))


def check_learner(learner: str, pairs: int) -> None:
    """Raises UsageError where there is no such learner, or fewer pairs of episodes than any can learn from."""
    if learner not in LEARNERS:
        raise UsageError(
            f"learner '{learner}' is unknown for the refinement gate (expected one of: {', '.join(LEARNERS)})"
        )
    if pairs < MIN_PAIRS:
        raise UsageError(f"{pairs} pairs of episodes, expected at least {MIN_PAIRS}")


def chosen(curve: list[dict[str, Any]], price_pct: float) -> dict[str, Any]:
    """The fewest slower episodes that `price_pct` points of clipped improvement buy."""
    affordable = [row for row in curve if row["price_pct"] <= price_pct] or curve[-1:]
    return min(affordable, key=lambda row: (row["slower_pct"], row["price_pct"]))


def judged(pairs: Pairs, kept: Bools, threshold: float) -> dict[str, Any]:
    """Figures of keeping the greedy choice where `kept`, shape (n,), says so."""
    slower = pairs.slower
    taken_s = np.where(kept, pairs.greedy_s, pairs.refined_s)
    confusion = [[int(np.sum((slower == was) & (kept == said))) for said in (False, True)] for was in (False, True)]
    return {
        "threshold": threshold,
        "n": len(slower),
        "right_pct": 100 * float(np.mean(kept == slower)),
        "kept_pct": 100 * float(kept.mean()),
        "improvement_pct": 100 * float(np.mean(1 - taken_s / pairs.greedy_s)),
        "price_pct": 100 * float(np.mean(np.where(kept, pairs.gain, 0.0))),
        "slower_pct": 100 * float(np.mean(taken_s > pairs.greedy_s)),
        "confusion": confusion,  # rows: refining was not slower, was slower; columns: refined, greedy kept
    }


def _said_by_twins(pairs: Pairs, learner: str, seed: int) -> Array:
    """The risk, shape (n,), each said by a twin that has not seen the pair."""
    fold = np.random.default_rng(seed).permutation(len(pairs.slower)) % FOLDS
    said = np.empty(len(fold))
    for k in range(FOLDS):
        said[fold == k] = pairs.grown(learner, fold != k, seed).risk(pairs.situations[fold == k])
    return said


def _rules(pairs: Pairs, names: tuple[str, ...]) -> tuple[str, ...]:
    stakes = np.abs(pairs.gain) + BASE_STAKE
    ((splits, shares),) = grow_tree(pairs.situations, pairs.slower, stakes, np.random.default_rng(0)).steps
    said = success_rules(splits, shares, space(names).features)
    return tuple(rule.replace("then success in", "then refining risks") for rule in said)
