"""Trains the models that predict whether an action succeeds (paper 5.4)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tailor.models.episodes.episodes import UNOBSERVED, Episode
from tailor.models.episodes.examples import Examples, split, success_examples
from tailor.models.features.features import FeatureSpace
from tailor.models.training import learners, scores
from tailor.models.training.training import TEST_SHARE, Trained, check_count, fit
from tailor.schemas.errors import UsageError

MIN_OUTCOMES = 5  # successes, and failures, to train on, if there are as many
MAX_DRAWS = 1000  # of a split; five of five are among three quarters in one of four


def train_success(episodes: Sequence[Episode], space: FeatureSpace, learner: str, seed: int) -> Trained:
    """Train a model of success on the first tick of each episode.

    Args:
      episodes: Episodes of one action; those with failure `UNOBSERVED` are left out.
      space: Feature space of the action's arguments.
      learner: Key of `learners.SUCCESS_LEARNERS`.
      seed: Random seed of splits and learner.

    Raises:
      UsageError: Fewer than MIN_EPISODES episodes, fewer of an outcome than the learner needs, all of them of too few
        runs to be split, or an unknown learner.
    """
    episodes = [episode for episode in episodes if episode.failure != UNOBSERVED]
    check_count(episodes, "")
    rows = success_examples(episodes, 1)
    _check_outcomes(rows, learner)
    kept, apart = _split_with_both_outcomes(rows, np.random.default_rng(seed))
    fresh = rows.of(apart)
    held_out = fit("success", learner, rows.of(kept), space, seed)
    features = space(fresh.arguments)
    observed, probability = fresh.targets > 0.5, held_out.predict_proba(features)[:, 1]
    table = scores.confusion(probability >= held_out.threshold_, observed)
    test = {
        "n": table.n,
        "training_episodes": len(kept),
        "failure_rate_pct": float(100 * (1 - rows.targets.mean())),
        "accuracy_pct": table.accuracy,
        "missed_failures_pct": table.success_fail,
        "false_alarms_pct": table.fail_success,
        "confusion_pct": [table.fail_fail, table.fail_success, table.success_fail, table.success_success],
        "reliability": [list(row) for row in scores.reliability(probability, observed)],
    }
    return Trained(fit("success", learner, rows, space, seed), 1, test)


def _check_outcomes(rows: Examples, learner: str) -> None:
    rarer, least = _rarer(rows), learners.least_outcomes(learner)
    if not rarer and least:
        raise UsageError("all episodes have the same outcome, expected some successes and some failures")
    if rarer < least:
        raise UsageError(f"{rarer} episodes with the rarer outcome, expected at least {least} for {learner}")


def _split_with_both_outcomes(rows: Examples, rng: np.random.Generator) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Episodes to train on and to test on; drawn again while too few of the rarer outcome are among the former."""
    rarer = _rarer(rows)
    for _ in range(MAX_DRAWS):
        kept, apart = split(rows.groups, TEST_SHARE, rng)
        if _rarer(rows.of(kept)) >= min(MIN_OUTCOMES, rarer):
            return kept, apart
    raise UsageError(f"the {rarer} episodes with the rarer outcome are of too few runs to train and to test on")


def _rarer(rows: Examples) -> int:
    """Number of examples with the rarer outcome."""
    successes = int((rows.targets > 0.5).sum())
    return min(successes, len(rows.targets) - successes)
