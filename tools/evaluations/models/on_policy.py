"""Effect of on-policy episodes: error and coverage at the optimiser's choices, before and after a round."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tailor.models.episodes.episodes import DataSet, Episode, merge, read_data_set
from tailor.models.episodes.examples import duration_examples, split
from tailor.models.episodes.sources import RUN_NUMBERS
from tailor.models.features.features import FeatureSpace
from tailor.models.training import scores
from tailor.models.training.calibration import MIN_EPISODES
from tailor.models.training.training import check_count, fit
from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import add_count
from tailor.tools.evaluations.models import fresh
from tailor.tools.evaluations.models.learned import configure_learned, feature_space_of, seeded
from tailor.tools.evaluations.pages.report import Report, publish_report
from tailor.tools.evaluations.paired_comparison import mean_over_runs
from tailor.tools.evaluations.progress import tracked
from tailor.tools.learning.gathering import random_episodes
from tailor.tools.learning.gathering.run_data_sets import modelled_actions

LEVEL = 0.9
SCENARIOS = ["approach-dribble", "waypoints"]


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate on-policy`."""
    configure_learned(parser, 80)
    parser.add_argument("--data", type=Path, help="random episodes (default: data/ROBOT)")
    parser.add_argument("--scenarios", nargs="+", default=SCENARIOS, help="(default %(default)s)")
    add_count(parser, "--ticks", 1, 2, "first ticks of each episode")


def run(arguments: argparse.Namespace) -> int:
    """Gather both rounds, compare and publish the report; exit code 0."""
    arguments = seeded(arguments)
    domain = random_episodes.domain_of(arguments.robot)
    runs = arguments.robot, arguments.scenarios, arguments.episodes
    where = arguments.zoo, arguments.jobs, arguments.store
    spaces = {action: feature_space_of(arguments.robot, action) for action in modelled_actions(domain)}
    random = {action: _random(action, arguments) for action in spaces}  # raises before hours of runs, not after
    first = fresh.run_seed(arguments.seed)  # one round to learn from, and one to judge by
    folders = [fresh.chosen(*runs, seed, *where) for seed in (first, first + 1)]
    chosen = {action: tuple(read_data_set(folder / action) for folder in folders) for action in spaces}
    judged = [action for action in spaces if all(any(e.finished for e in each.episodes) for each in chosen[action])]
    if not judged:
        raise UsageError(
            f"{', '.join(arguments.scenarios)}: no action finished in both rounds, expected more --episodes"
        )
    rows = [
        row
        for action in tracked(judged, "actions")
        for row in _rows(action, spaces[action], (random[action], *chosen[action]), arguments)
    ]
    remarks = [
        *(
            f"{action}: never chosen and done in both rounds, so there are no rows"
            for action in spaces
            if action not in judged
        ),
        "coverage: share of errors within the interval that holds 90 % on held-out random episodes",
        "recalibrated: within the one that holds 90 % on held-out on-policy episodes; `tailor train` does the same",
    ]
    report = Report("on-policy", "One on-policy round", rows, remarks, {}, arguments.provenance)
    publish_report(report, arguments)
    return 0


def _random(action: str, arguments: argparse.Namespace) -> DataSet:
    """An action's random episodes.

    Raises:
      UsageError: There are none, or too few of them finished to learn from.
    """
    folder = Path(arguments.data or Path("data") / arguments.robot) / action
    data = read_data_set(folder)
    try:
        check_count([episode for episode in data.episodes if episode.finished], "finished")
    except UsageError as error:
        raise UsageError(f"{folder}: {error}") from None
    return data


def _rows(
    action: str, space: FeatureSpace, sets: tuple[DataSet, ...], arguments: argparse.Namespace
) -> list[dict[str, Any]]:
    """Rows of an action, by its random episodes, the choices to learn from, and those to judge by."""
    random, chosen, later = sets
    kept, apart = split(np.arange(len(random.episodes)), 0.25, np.random.default_rng(arguments.seed))
    known = [random.episodes[k] for k in kept]
    unseen = [random.episodes[k] for k in apart]
    more = [e for e in merge([random, chosen]).episodes if e.number >= len(random.episodes)]
    taught, held = split(np.arange(len(more)), 0.25, np.random.default_rng(arguments.seed))
    both = [*known, *(more[k] for k in taught)]
    kinds = (("random", known, more), ("random and on-policy", both, [more[k] for k in held]))
    rows = []
    for name, episodes, apart_chosen in kinds:
        judges = _Judges(unseen, apart_chosen, later.episodes)
        figures = _judged([e for e in episodes if e.finished], judges, space, arguments)
        rows.append({"action": action, "training_data": name, "episodes": len(episodes), **figures})
    return rows


@dataclass(frozen=True, slots=True)
class _Judges:
    """Episodes that no model has learned from."""

    random: Sequence[Episode]
    held: Sequence[Episode]  # of the round that was learned from: those that the model has not seen
    fresh: Sequence[Episode]  # of a round of its own


def _judged(
    episodes: Sequence[Episode], judges: _Judges, space: FeatureSpace, arguments: argparse.Namespace
) -> dict[str, Any]:
    """Errors on random episodes and on those of the optimiser's choices, and what intervals hold before and after."""
    model = fit("duration", "bag", duration_examples(episodes, arguments.ticks), space, arguments.seed)
    figures: dict[str, Any] = {}
    before = scores.interval_factor(*_errors(model, judges.random, space), LEVEL)
    for name, some, per_run in (("random", judges.random, 1), ("policy", judges.fresh, RUN_NUMBERS)):
        off, spread = _errors(model, some, space)
        runs = [episode.number // per_run for episode in some if episode.finished]
        mae, ci = mean_over_runs(np.abs(off), runs, arguments.seed)
        figures |= {f"{name}_mae_s": mae, f"{name}_ci95": ci, f"{name}_bias_s": float(off.mean())}
        figures[f"{name}_coverage_pct"] = scores.coverage(off, spread, before)
    count = sum(episode.finished for episode in judges.held)
    enough = count >= MIN_EPISODES  # as in `tailor train`: fewer say little about a tenth of them
    after = scores.interval_factor(*_errors(model, judges.held, space), LEVEL) if enough else before
    figures["policy_recalibrated_pct"] = scores.coverage(*_errors(model, judges.fresh, space), after)
    return {
        **figures,
        "factor": before,
        "factor_recalibrated": after,
        "calibrated_on": count if enough else 0,
    }


def _errors(model: Any, episodes: Sequence[Episode], space: FeatureSpace) -> tuple[Any, Any]:
    """Predicted minus observed seconds, and the model's spread, at the first ticks."""
    rows = duration_examples([e for e in episodes if e.finished], 1)
    mean, spread = model.predict_with_std(space(rows.arguments))
    return mean - rows.targets, spread
