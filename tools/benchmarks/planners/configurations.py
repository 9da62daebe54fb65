"""Benchmark of configurations: problems of the project solved within 1000 and 10 000 generated plans."""

from __future__ import annotations

from dataclasses import replace

from rich.console import Console
from rich.table import Table

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import DEFAULT, FlawOrder, Search, Settings
from tailor.executive.planning.settings import DEFAULT_RANKINGS
from tailor.tools.benchmarks.planning import UNLIMITED, names, read, texts
from tailor.tools.benchmarks.planning_scale import problem_text

LIMITS = (1000, 10_000)
CUPS = (4, 5, 6)  # problems beyond those of the project, of 16, 20 and 24 steps


def _with(*orders: str) -> Settings:
    return Settings(DEFAULT_RANKINGS, tuple(map(FlawOrder, orders)), engine="pocl")


CONFIGURATIONS = {
    "default: both engines by turns": DEFAULT,
    "partial order, MW-Loc and LCFR-Loc-Conf": _with("MW-Loc", "LCFR-Loc-Conf"),
    "partial order, MW-Loc": _with("MW-Loc"),
    "partial order, LCFR-Loc-Conf": _with("LCFR-Loc-Conf"),
    "partial order, UCPOP": _with("UCPOP"),
    "MW-Loc with variables (lifted)": replace(_with("MW-Loc"), ground=False),
    "through states": replace(DEFAULT, engine="forward"),
}


def problems() -> list[tuple[str, str]]:
    """PDDL texts of domain and problem."""
    kitchen = texts("kitchen-s1")[0]
    return [*map(texts, names()), *((kitchen, problem_text(cups)) for cups in CUPS)]


def solved(settings: Settings, limit: int) -> int:
    """Number of the problems that a configuration solves within so many generated plans."""
    count = 0
    for domain_and_problem in problems():
        problem = read(*domain_and_problem)
        result = Search(problem.domain, problem, replace(settings, node_limit=limit)).advance(CheckBudget(UNLIMITED))
        count += result is not None and result.plan is not None
    return count


def run(console: Console, quick: bool) -> None:
    """Print one row for each configuration."""
    table = Table(title=f"problems solved, of {len(problems())}, by generated plans", box=None)
    table.add_column("configuration", no_wrap=True)
    limits = LIMITS[:1] if quick else LIMITS
    for limit in limits:
        table.add_column(str(limit), justify="right")
    for name, settings in CONFIGURATIONS.items():
        table.add_row(name, *(str(solved(settings, limit)) for limit in limits))
    console.print(table)
