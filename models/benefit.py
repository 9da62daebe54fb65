"""Learns when not to refine (paper 6.3.2): from paired episodes, whether refining cost time, by what both choices say.

A pair is one start run twice with the same noise, greedy and refined. Everything that the card reports was said by
twins that had not seen the pair.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.distilled_failure import DistilledFailureTree
from models.failure_forest import FailureForest
from models.failure_tree import FailureModel, FailureTree
from models.features import FeatureSpace, Quantity
from models.rules import success_rules
from schemas.errors import UsageError

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

LEAST = 100  # pairs: fewer say nothing about a few in a hundred
FOLDS = 8
THRESHOLDS = tuple(round(0.2 + 0.025 * k, 3) for k in range(17))  # 0.2 .. 0.6
LEARNERS: Mapping[str, Callable[[int], FailureModel]] = {
    "forest": lambda seed: FailureForest(trees=96, random_state=seed),
    "distilled": lambda seed: DistilledFailureTree(leaves=12, random_state=seed),
    "tree": lambda seed: FailureTree(min_rows=25, random_state=seed),
}


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


@dataclass(frozen=True, slots=True)
class TrainedBenefit:
    """A learner fitted to all pairs, the probability above which greedy is kept, and what its twins reached."""

    learner: FailureModel
    threshold: float
    test: Mapping[str, Any]
    rules: tuple[str, ...]  # of one small tree that says nearly the same


def space(names: tuple[str, ...]) -> FeatureSpace:
    """Situations as they are told; a name ends in its unit."""
    units = {"s": "s", "pct": "%", "rad": "rad"}
    quantities = tuple(Quantity(name, units.get(name.rpartition("_")[2], "1")) for name in names)
    return FeatureSpace("situation", quantities, quantities, lambda columns, _: columns)


def train_benefit(pairs: Pairs, names: tuple[str, ...], learner: str, seed: int) -> TrainedBenefit:
    """Learn from pairs; the same pairs and seed give the same tree.

    Args:
      pairs: Of training seeds.
      names: Of the columns of the situations.
      learner: One of LEARNERS.
      seed: Draws folds and what the learner draws.

    Raises:
      UsageError: Too few pairs, pairs that all ended alike, or an unknown learner.
    """
    if learner not in LEARNERS:
        raise UsageError(f"learner '{learner}' is unknown for benefit (expected one of: {', '.join(LEARNERS)})")
    if len(pairs.slower) < LEAST:
        raise UsageError(f"{len(pairs.slower)} pairs of episodes, expected at least {LEAST}")
    if len(np.unique(pairs.slower)) < 2:
        raise UsageError("refining ended alike in all pairs, expected some slower and some not")
    unseen = _said_by_twins(pairs, learner, seed)
    curve = [judged(pairs, unseen > threshold, threshold) for threshold in THRESHOLDS]
    best = _best(curve, pairs)
    few = LEARNERS["distilled"](seed).fit(pairs.situations, pairs.slower)
    splits, said = few.steps_[0]
    lines = [
        rule.replace("then success in", "then slower in") for rule in success_rules(splits, said, space(names).features)
    ]
    test = {**best, "ungated": judged(pairs, np.zeros_like(pairs.slower), 1.0), "curve": curve}
    return TrainedBenefit(
        LEARNERS[learner](seed).fit(pairs.situations, pairs.slower), best["threshold"], test, tuple(lines)
    )


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
        "slower_pct": 100 * float(np.mean(taken_s > pairs.greedy_s)),
        "confusion": confusion,  # rows: refining was not slower, was slower; columns: refined, greedy kept
    }


def _said_by_twins(pairs: Pairs, learner: str, seed: int) -> Array:
    """Probability that refining is slower, shape (n,), each said by a twin that has not seen the pair."""
    fold = np.random.default_rng(seed).permutation(len(pairs.slower)) % FOLDS
    said = np.empty(len(fold))
    for k in range(FOLDS):
        twin = LEARNERS[learner](seed).fit(pairs.situations[fold != k], pairs.slower[fold != k])
        said[fold == k] = twin.predict_proba(pairs.situations[fold == k])[:, 1]
    return said


def _best(curve: list[dict[str, Any]], pairs: Pairs) -> dict[str, Any]:
    """Most often right among the thresholds that do not cost time on average; of equals the most careful one."""
    plain = judged(pairs, np.zeros_like(pairs.slower), 1.0)["improvement_pct"]
    good = [row for row in curve if row["improvement_pct"] >= plain] or curve[-1:]
    return max(good, key=lambda row: (row["right_pct"], -row["slower_pct"]))
