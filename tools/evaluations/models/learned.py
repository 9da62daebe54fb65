"""Flags that the evaluations of learned models share."""

from __future__ import annotations

import argparse

from tailor.tools.cli.number_checks import at_least
from tailor.tools.evaluations.report import configure_report

PAPER_EPISODES = 750  # Table 1: training episodes of the simulated soccer robot


def configure_train(parser: argparse.ArgumentParser) -> None:
    """How many episodes to learn from."""
    parser.add_argument(
        "--train",
        type=at_least(40, "--train"),
        default=PAPER_EPISODES,
        help="episodes learned from (default %(default)s)",
    )


def configure_learned(parser: argparse.ArgumentParser, episodes: int) -> None:
    """Declare robot, number of fresh episodes, seed, and the flags of the report."""
    parser.add_argument("--robot", default="agilo", help="whose models (default %(default)s)")
    parser.add_argument(
        "--episodes", type=at_least(2, "--episodes"), default=episodes, help="fresh episodes (default %(default)s)"
    )
    parser.add_argument(
        "--seed", type=at_least(0, "--seed"), default=1, help="draws the fresh episodes (default %(default)s)"
    )
    configure_report(parser)
