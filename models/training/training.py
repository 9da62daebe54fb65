"""Trains action models and tests them on held-out episodes; the published model is fitted to all episodes.

Episodes are never split between training and test.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sklearn.base import clone

from tailor.models.episodes.episodes import Episode
from tailor.models.episodes.examples import Examples, split
from tailor.models.episodes.regression_targets import DURATION, RegressionTarget
from tailor.models.features.features import FeatureSpace
from tailor.models.regression.blend import BlendedRegressor
from tailor.models.regression.calibrated import NOT_JUDGED, CalibratedRegressor
from tailor.models.regression.intervals import FORMER, MIN_OWN, RANDOM
from tailor.models.training import learners, scores
from tailor.models.training.calibration import judged
from tailor.models.training.first_ticks import best_n_i
from tailor.models.training.fitting import absolute_errors, fitted
from tailor.schemas.errors import UsageError

Array = NDArray[np.float64]

TEST_SHARE = 0.25  # of the episodes (paper 5.1)
CURVE = (0.125, 0.25, 0.5, 0.75)  # shares, besides all of them, of the training episodes in the learning curve
MIN_EPISODES = 40  # fewer cannot be split four ways


@dataclass(frozen=True, slots=True)
class Trained:
    """A trained model.

    Attributes:
      learner: The estimator, fitted to all episodes.
      n_i: Number of first ticks of each episode that it was fitted to.
      test: Scores of the same learner fitted to three quarters of the episodes, on the others; as in a card.
    """

    learner: Any
    n_i: int
    test: Mapping[str, Any]


def train_duration(episodes: Sequence[Episode], space: FeatureSpace, learner: str, seed: int) -> Trained:
    """Train a model of durations, in seconds; see `train_regression`."""
    return train_regression(DURATION, episodes, space, learner, seed)


def train_duration_alone(episodes: Sequence[Episode], space: FeatureSpace, learner: str, seed: int) -> Trained:
    """Train a model of durations with the intervals of those without objects; see `train_duration_beside`."""
    return train_regression(DURATION, episodes, space, learner, seed, judges=lambda episode: not episode.in_context)


def train_duration_beside(episodes: Sequence[Episode], space: FeatureSpace, learner: str, seed: int) -> Trained:
    """Train a model of durations beside objects: that of all episodes, with the intervals of those in a context.

    Controllers may drive otherwise where they know of objects, and no argument says so.

    Raises:
      UsageError: See `train_regression`.
    """
    return train_regression(DURATION, episodes, space, learner, seed, judges=lambda episode: episode.in_context)


def train_regression(
    target: RegressionTarget,
    episodes: Sequence[Episode],
    space: FeatureSpace,
    learner: str,
    seed: int,
    judges: Callable[[Episode], bool] = lambda _: True,
) -> Trained:
    """Train a model of durations or energies on the finished episodes.

    Args:
      target: `DURATION` or `ENERGY`.
      episodes: Episodes of one action; those that calibrate only correct the intervals.
      space: Feature space of the action's arguments.
      learner: Key of `learners.DURATION_LEARNERS`.
      seed: Random seed of splits and learner.
      judges: Whether the intervals and the test are for actions as this episode's; all are learned from.

    Raises:
      UsageError: Fewer than MIN_EPISODES finished episodes hold the target, or the learner is unknown.
    """
    usable = [episode for episode in episodes if episode.finished and target.is_recorded(episode)]
    finished = [episode for episode in usable if not episode.calibrates]
    check_count(finished, "finished")
    choices = _choices(target, [episode for episode in usable if episode.calibrates and judges(episode)])
    rng = np.random.default_rng(seed)
    judging = _judging(finished, judges)
    kinds = dict.fromkeys((episode.number for episode in finished), NOT_JUDGED)
    kinds |= {episode.number: FORMER if episode.on_policy else RANDOM for episode in judging}
    numbers = np.array([episode.number for episode in finished])
    kept, apart = split(numbers, TEST_SHARE, rng)
    singles = learners.single_learners(learners.learner_name(target.kind, learner), seed)
    n_i = best_n_i(target, finished, kept, space, singles, rng)
    rows = target.examples(finished, n_i)
    first = target.examples(judging, 1).of(apart)
    held_out = fitted(learners.calibrated(target.kind, learner, seed), rows.of(kept), space, kinds, choices)
    chosen = held_out.inner_.frozen() if isinstance(held_out.inner_, BlendedRegressor) else held_out.inner
    test = {
        "n": len(first.targets),
        "training_episodes": len(kept),
        f"mean_{target.kind}_{target.unit}": float(np.mean([target.whole(episode) for episode in judging])),
        **_tested(held_out, rows, first, judging, space, target.unit, rng),
        "learning_curve": _curve(chosen, held_out, rows, first, kept, space, rng),
        **({"cv_mae": held_out.inner_.cv_mae_} if hasattr(held_out.inner_, "cv_mae_") else {}),
    }
    return Trained(fitted(CalibratedRegressor(chosen, seed), rows, space, kinds, choices), n_i, test)


def _judging(finished: Sequence[Episode], judges: Callable[[Episode], bool]) -> list[Episode]:
    """Episodes that judge intervals and test: none selected for what a model did not know, unless nearly all are.

    Of a few others the test might hold none, and one error would be the width of every interval.
    """
    judging = [episode for episode in finished if judges(episode)]
    usual = [episode for episode in judging if not episode.selected]
    return usual if len(usual) >= MIN_EPISODES else judging


def _choices(target: RegressionTarget, episodes: Sequence[Episode]) -> Examples | None:
    """The first rows of the episodes that correct the intervals; None if they are too few for that."""
    return target.examples(episodes, 1) if len(episodes) >= MIN_OWN else None


def _tested(
    held_out: Any,
    rows: Examples,
    first: Examples,
    judging: Sequence[Episode],
    space: FeatureSpace,
    unit: str,
    rng: np.random.Generator,
) -> dict[str, Any]:
    """Errors and intervals of a learner on episodes that it has not seen: those of `first`, out of `judging`."""
    mean, lower, upper = held_out.predict_interval(space(first.arguments))
    errors = first.targets - mean
    mae, ci = scores.mean_with_ci(np.abs(errors), rng)
    on_policy = {episode.number: episode.on_policy for episode in judging}
    return {
        f"mae_{unit}": mae,
        "mae_ci95": list(ci),
        f"mae_first_ticks_{unit}": _mae(held_out, rows.of(first.groups), space),
        f"bias_{unit}": float(-errors.mean()),
        **judged(first.targets, lower, upper, np.array([on_policy[number] for number in first.groups.tolist()])),
    }


def fit(kind: str, name: str, rows: Examples, space: FeatureSpace, seed: int) -> Any:
    """Fit a learner to examples.

    Args:
      kind: "duration", "energy" or "success".
      name: Name of the learner, see `learners.make_learner`.
      rows: Examples.
      space: Feature space of their arguments.
      seed: Random seed.

    Returns:
      The fitted estimator.
    """
    learner = learners.make_learner(kind, name, seed)
    targets = rows.targets if kind != "success" else rows.targets.astype(np.int64)
    return learner.fit(space(rows.arguments), targets, groups=rows.groups)


def check_count(episodes: Sequence[Episode], what: str) -> None:
    """Raise a UsageError if the episodes are too few."""
    if len(episodes) < MIN_EPISODES:
        raise UsageError(f"{len(episodes)} {what} episodes, expected at least {MIN_EPISODES}".replace("  ", " "))


def _mae(learner: Any, rows: Examples, space: FeatureSpace) -> float:
    return float(absolute_errors(learner, rows, space).mean())


def _curve(
    learner: Any,
    whole: Any,
    rows: Examples,
    test: Examples,
    kept: NDArray[np.int64],
    space: FeatureSpace,
    rng: np.random.Generator,
) -> list[list[float]]:
    """MAE on the test episodes against the number of training episodes (paper 5.1); `whole` is fitted to all."""
    order, curve = rng.permutation(kept), []
    for share in CURVE:
        some = order[: round(share * len(order))]
        curve.append([len(some), _mae(fitted(clone(learner), rows.of(some), space), test, space)])
    return [*curve, [len(order), _mae(whole, test, space)]]
