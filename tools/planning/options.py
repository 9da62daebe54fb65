"""Options of `tailor plan`, with the letters and names of VHPOP."""

from __future__ import annotations

import argparse
import dataclasses
import sys
from pathlib import Path
from typing import Any, get_args

from tailor import __version__
from tailor.executive.planning import EngineName, FlawOrder, Settings
from tailor.executive.planning.flaws.flaw_orders import NAMED
from tailor.executive.planning.flaws.ranking import NAMES
from tailor.executive.planning.pddl.syntax.errors import shortened
from tailor.schemas.errors import UsageError
from tailor.tools.plan_search.limits import GROUND_LIMIT, MAX_PLANS

MAX_DIGITS = 18  # of a number: Python refuses to read thousands


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the arguments; -h is the ranking as in VHPOP, so help is --help only."""
    parser.conflict_handler = "resolve"
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = f"flaw orders by name: {', '.join(NAMED)}"
    parser.add_argument(
        "files",
        metavar="FILE",
        nargs="*",
        type=Path,
        help="PDDL, first DOMAIN, then PROBLEM: two files, or both in one file or on standard input (-, or no file)",
    )
    parser.add_argument("-V", "--version", action="version", version=f"tailor {__version__}")
    search = parser.add_argument_group("search, as in VHPOP")
    _configure_search(search)
    _configure_costs(search)
    parser.set_defaults(node_limit=MAX_PLANS)
    _configure_planners(parser.add_argument_group("other planners"))
    _configure_output(parser.add_argument_group("output"))


def _configure_search(group: argparse._ArgumentGroup) -> None:
    add = group.add_argument
    add("-g", "--ground-actions", dest="ground", action="store_true", default=True, help="ground actions (default)")
    add("--lifted", dest="ground", action="store_false", help="plan with variables instead of ground actions")
    add("-h", "--heuristic", metavar="RANKING",
        help=f"rankings joined by '/': {' '.join(NAMES)} (default ADDR/ADDR_WORK/BUC/LIFO)")  # fmt: skip
    add("-d", "--domain-constraints", *(f"-d{level}" for level in range(10)), action="store_true",
        help=argparse.SUPPRESS)  # as VHPOP's; lifted planning always keeps the domains of parameters  # fmt: skip
    add("--anytime", action="store_true",
        help="after the first plan search for better ones by the metric, within the limits")  # fmt: skip
    add("--engine", choices=(*get_args(EngineName), "kairos"), default="auto",
        help="partial-order search, search through states, both by turns (auto, default), or kairos-planner; auto "
        "also uses that for durative problems, if it is installed")  # fmt: skip
    add("-f", "--flaw-order", dest="orders", metavar="ORDER", action=_AppendOrder, default=[],
        help="flaw order, by name or as {n,s}LR; several in round robin (default MW-Loc, LCFR-Loc-Conf)")  # fmt: skip
    add("-l", "--limit", dest="orders", metavar="N", action=_LimitOrder,
        help="maximum number of plans of the preceding flaw order (of the search if none), or 'unlimited'")  # fmt: skip
    add("-s", "--search-algorithm", dest="search", choices=("A", "IDA"), default="A",
        type=lambda name: name.upper().removesuffix("*"), help="A* (default) or IDA*")  # fmt: skip


def _configure_costs(group: argparse._ArgumentGroup) -> None:
    add = group.add_argument
    add("-w", "--weight", type=float, default=1.0,
        help="weight of the heuristic against the cost of the steps (default 1)")  # fmt: skip
    costs = ("UNIT", "DURATION", "RELATIVE", "METRIC")
    add("-a", "--action-cost", choices=costs, default="UNIT", type=str.upper,
        help="cost of a step: 1, its duration, that relative to the shortest, or its (total-cost) "
        "(default UNIT)")  # fmt: skip
    add("-t", "--tolerance", type=_tolerance, default=0.01, metavar="S",
        help="tick of a durative plan in seconds (default 0.01); 'unlimited', as VHPOP 2 has it, is no time "
        "limit")  # fmt: skip
    add("-r", "--random-open-conditions", action="store_true", help="add open conditions in random order")
    add("-S", "--seed", type=int, default=0, help="random seed (default 0)")
    add("-T", "--time-limit", type=_minutes, default=None, metavar="MINUTES",
        help="time limit of the search in minutes, fractions allowed, or 'unlimited' (default)")  # fmt: skip
    add("--memory-limit", type=_megabytes, default=448, metavar="MB",
        help="memory limit of the search, or 'unlimited' (default 448: with that of Python less than 512)")  # fmt: skip


def _configure_planners(group: argparse._ArgumentGroup) -> None:
    group.add_argument("--planner", metavar="COMMAND",
        help="plan with an external program in its own process with time and memory limits, e.g. 'vhpop -g -f MW-Loc', "
        "or with kairos, kairos:SECONDS, kairos:SECONDS:TICK, up:ENGINE (of unified-planning)")  # fmt: skip
    group.add_argument("--compare", metavar="COMMAND", action="append", default=[],
        help="print our plan's figures and validity beside those of another planner's, named as for --planner; "
        "repeatable, each with the time limit of -T (default one minute)")  # fmt: skip


def _configure_output(group: argparse._ArgumentGroup) -> None:
    forms = group.add_mutually_exclusive_group()
    forms.add_argument("--links", action="store_true", help="print causal links and orderings (Figure 10 of the paper)")
    forms.add_argument("--json", action="store_true", help="print one JSON object, also if there is no plan")
    forms.add_argument("--dot", action="store_true", help="print the partial order as a Graphviz graph")
    forms.add_argument("--svg", action="store_true", help="print the partial order as an SVG image")
    group.add_argument(
        "-v", "--verbose", action="store_true", help="print the cost of the search on standard error (also -v1 ...)"
    )
    levels = [f"{option}{level}" for option in ("-v", "--verbose=") for level in range(100)]
    group.add_argument(*levels, dest="verbose", action="store_true", help=argparse.SUPPRESS)


def settings_of(args: argparse.Namespace) -> Settings:
    """The search settings of the options."""
    chosen: dict[str, Any] = {"flaw_orders": tuple(args.orders)} if args.orders else {}
    return Settings(
        rankings=() if args.heuristic is None else tuple(args.heuristic.split("/")),
        search=args.search,
        ground=args.ground,
        weight=args.weight,
        action_cost=args.action_cost.lower(),
        node_limit=args.node_limit,
        ground_limit=GROUND_LIMIT,
        tolerance_s=args.tolerance,
        seed=args.seed,
        random_open_conditions=args.random_open_conditions,
        engine=args.engine,
        **chosen,
    )


# --- values ---------------------------------------------------------------------------------------
class _AppendOrder(argparse.Action):
    """-f ORDER: appends a flaw order."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: Any = None) -> None:
        namespace.orders = [*namespace.orders, FlawOrder(str(values))]


class _LimitOrder(argparse.Action):
    """-l N: limits the preceding flaw order, or the whole search if there is none."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: Any = None) -> None:
        limit = None if values == "unlimited" else _positive(values)
        if namespace.orders:
            *before, last = namespace.orders
            namespace.orders = [*before, dataclasses.replace(last, limit=limit)]
        else:
            namespace.node_limit = limit if limit is not None else sys.maxsize


def _minutes(text: str) -> float:
    """A time limit in minutes."""
    if text == "unlimited":
        return float("inf")
    try:
        minutes = float(text)
    except ValueError:
        minutes = -1.0
    if not minutes >= 0:
        raise UsageError(f"--time-limit: expected a number of minutes of at least 0, found '{text}'")
    return minutes


def _tolerance(text: str) -> float:
    """A tick in seconds; VHPOP 2's time limit "unlimited" is the default, 0.01."""
    if text == "unlimited":
        return 0.01
    try:
        return float(text)
    except ValueError:
        raise UsageError(f"--tolerance: expected a tick in seconds, found '{text}'") from None


def _megabytes(text: str) -> float:
    """A limit of memory in MB."""
    if text == "unlimited":
        return float("inf")
    if not _is_positive(text):
        raise UsageError(f"--memory-limit: expected a whole number of MB or 'unlimited', found '{shortened(text)}'")
    return float(text)


def _positive(text: str) -> int:
    if not _is_positive(text):
        raise UsageError(f"--limit: expected a number of plans of at least 1 or 'unlimited', found '{shortened(text)}'")
    return int(text)


def _is_positive(text: str) -> bool:
    """Whether a text is a whole number of at least 1, of so many digits that Python reads it."""
    return text.isdecimal() and len(text) <= MAX_DIGITS and int(text) >= 1
