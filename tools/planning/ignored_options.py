"""Refuses options of `tailor plan` that the chosen planner would ignore in silence."""

from __future__ import annotations

import argparse

from tailor.schemas.errors import UsageError
from tailor.tools.cli.given_options import given_options
from tailor.tools.planning import options

_SEARCH = {"--lifted": "ground", "-h": "heuristic", "-f": "orders", "-s": "search", "-w": "weight",
           "-a": "action_cost", "-r": "random_open_conditions"}  # fmt: skip
_ALL = {**_SEARCH, "-l": "node_limit", "-S": "seed", "--memory-limit": "memory_limit", "--anytime": "anytime"}


def refuse_ignored(args: argparse.Namespace) -> None:
    """Raises UsageError for options that mean nothing to the planner of `--planner` or `--engine`."""
    if args.planner is not None:
        if not args.planner.strip():
            raise UsageError("--planner: expected a command, found ''")
        _refuse(args, "an external planner", {**_ALL, "-t": "tolerance", "--engine": "engine"})
    elif args.engine == "kairos":
        _refuse(args, "--engine kairos", _ALL)
    elif args.engine == "forward" and not args.anytime:  # anytime search goes on through partial plans
        _refuse(args, "--engine forward", _SEARCH)


def _refuse(args: argparse.Namespace, planner: str, names: dict[str, str]) -> None:
    given = given_options(options.configure, args, names)
    if given:
        raise UsageError(f"{planner} does not use {', '.join(given)}: leave {'it' if len(given) == 1 else 'them'} out")
