"""Flags that the evaluations of learned models share."""

from __future__ import annotations

import argparse
from pathlib import Path

from tailor.executive import domains
from tailor.models.features.features import FeatureSpace
from tailor.tools.cli.number_checks import add_count
from tailor.tools.evaluations.pages.report import configure_report
from tailor.tools.evaluations.seeds import seeds_of
from tailor.tools.learning.gathering import random_episodes
from tailor.tools.learning.gathering.data_set_spec import argument_names
from tailor.tools.learning.training_request import TrainingRequest, spaces_by_kind

PAPER_EPISODES = 750  # Table 1: training episodes of the simulated soccer robot


def configure_train(parser: argparse.ArgumentParser) -> None:
    """How many episodes to learn from."""
    add_count(parser, "--train", 40, PAPER_EPISODES, "episodes learned from")


def configure_learned(parser: argparse.ArgumentParser, episodes: int) -> None:
    """Declare robot, number of fresh episodes, and the flags of the report."""
    parser.add_argument("--robot", default="agilo", help="whose models (default %(default)s)")
    add_count(parser, "--episodes", 2, episodes, "fresh episodes")
    configure_report(parser)


def seeded(arguments: argparse.Namespace) -> argparse.Namespace:
    """The arguments with the first seed of the robot's evaluations, and `provenance`, where it comes from."""
    seeds = seeds_of(random_episodes.domain_of(arguments.robot), arguments)
    return argparse.Namespace(**{**vars(arguments), "seed": seeds.first, "provenance": seeds.provenance})


def feature_space_of(robot: str, action: str, features: str | None = None) -> FeatureSpace:
    """The feature space of that name, or the default one, for durations and successes of a robot's action.

    Raises:
      UsageError: No such robot or action, or the space takes other arguments than the action has.
    """
    domain = random_episodes.domain_of(robot)
    random_episodes.check_action(domain, action)
    names = tuple(argument_names(domains.load(domain), action))
    return spaces_by_kind(TrainingRequest(robot, Path(), features=features), names, Path(robot, action))["duration"]
