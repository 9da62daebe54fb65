"""Flags that the evaluations of learned models share."""

from __future__ import annotations

import argparse

from tools.evaluations.report import configure_report

PAPER_EPISODES = 750  # Table 1: training episodes of the simulated soccer robot


def configure_learned(parser: argparse.ArgumentParser, episodes: int) -> None:
    """Robot, fresh episodes, seed, and how to tell the result."""
    parser.add_argument("--robot", default="agilo", help="whose models (default %(default)s)")
    parser.add_argument("--episodes", type=int, default=episodes, help="fresh episodes (default %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="draws the fresh episodes (default %(default)s)")
    configure_report(parser)
