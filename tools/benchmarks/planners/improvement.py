"""Benchmark of anytime search: makespan or cost of each better plan, over generated plans and CPU time."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

from rich.console import Console
from rich.table import Table

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import DEFAULT, AnytimeSearch
from tailor.tools.benchmarks.planning import UNLIMITED, names, read, texts

LIMIT, QUICK_LIMIT = 20_000, 2000  # generated plans after the first plan
COSTS = {"navigate": 5, "reach": 3}  # of the actions of the kitchen by their beginning; the others cost 1


@dataclass(frozen=True, slots=True)
class Improvement:
    """A better plan: its makespan or cost, and the work until it was found."""

    value: float
    generated: int
    cpu_s: float


def improvements(domain_text: str, problem_text: str, limit: int) -> tuple[str, list[Improvement], str]:
    """What anytime search minimises, each better plan, and why the search has ended."""
    problem = read(domain_text, problem_text)
    search = AnytimeSearch(problem.domain, problem, replace(DEFAULT, node_limit=limit))
    found, started_s = [], time.process_time()
    while not search.ended:
        result = search.advance(CheckBudget(UNLIMITED))
        if result is not None and result.plan is not None:
            found.append(Improvement(search.value, search.counts[0], time.process_time() - started_s))
    return search.measure, found, search.ended


def with_costs(domain_text: str, problem_text: str) -> tuple[str, str]:
    """A problem whose actions have costs, to be minimised."""
    head, *actions = domain_text.split("(:action ")
    priced = []
    for action in actions:
        cost = next((cost for name, cost in COSTS.items() if action.startswith(name)), 1)
        priced.append(action.replace(":effect (and", f":effect (and (increase (total-cost) {cost})"))
    domain = "(:action ".join([f"{head}(:functions (total-cost)) ", *priced])
    return domain, f"{problem_text.rstrip().removesuffix(')')} (:metric minimize (total-cost)))"


def run(console: Console, quick: bool) -> None:
    """Print one row for each problem with durations, and for the kitchen with costs."""
    table = Table(title="anytime: value, plans generated and CPU seconds at each improvement", box=None)
    for column in ("problem", "minimises", "improvements", "ended"):
        table.add_column(column, no_wrap=column != "improvements")
    tasks = {name: texts(name) for name in names() if "durative" in name}
    tasks |= {f"{name} with costs": with_costs(*texts(name)) for name in ("kitchen-s2", "kitchen-s3")}
    for name, task in tasks.items():
        measure, found, ended = improvements(*task, QUICK_LIMIT if quick else LIMIT)
        course = ", ".join(f"{each.value:g} ({each.generated}, {each.cpu_s:.2f} s)" for each in found)
        table.add_row(name, measure, course, ended)
    console.print(table)
