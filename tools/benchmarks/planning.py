"""Benchmark of the planner on the project's problems, with the counts of VHPOP and the memory per plan.

Times are CPU milliseconds of the best of several runs, parsing and grounding included. The counts of VHPOP are from
tests/data/pddl/reference.csv (version 2.2.1, one flaw order: MW-Loc).
"""

from __future__ import annotations

import csv
import gc
import resource
import subprocess
import sys
import time
import tracemalloc
from dataclasses import replace
from pathlib import Path

from rich.console import Console
from rich.table import Table

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import MATCHING, Problem, Result, Search, parse_domain, parse_problem
from tailor.tools.benchmarks.no_measurement import NoMeasurement

DATA = Path(__file__).resolve().parents[2] / "tests" / "data" / "pddl"
UNLIMITED = 10**9  # checks
RUNS = 15


def names() -> list[str]:
    """Names of the benchmark problems."""
    return sorted(path.stem for path in (DATA / "own").glob("*.pddl") if not path.stem.endswith("-domain"))


def texts(name: str) -> tuple[str, str]:
    """PDDL text of domain and problem."""
    folder = DATA / "own"
    return (folder / f"{name.rsplit('-', 1)[0]}-domain.pddl").read_text(), (folder / f"{name}.pddl").read_text()


def plan(domain_text: str, problem_text: str) -> tuple[Result, float]:
    """The result and the CPU milliseconds of grounding and search."""
    problem = read(domain_text, problem_text)
    started = time.process_time()
    result = Search(problem.domain, problem, MATCHING).advance(CheckBudget(UNLIMITED))
    assert result is not None
    return result, (time.process_time() - started) * 1e3


def read(domain_text: str, problem_text: str) -> Problem:
    """The problem of two texts."""
    return parse_problem(problem_text, parse_domain(domain_text))


def rows(quick: bool = False) -> list[dict[str, object]]:
    """One row for each problem."""
    return [_row(name, 2 if quick else RUNS) for name in names()]


def _row(name: str, runs: int) -> dict[str, object]:
    domain_and_problem = texts(name)
    times = []
    searches = []
    for _ in range(runs):
        started = time.process_time()
        result, search_ms = plan(*domain_and_problem)
        times.append((time.process_time() - started) * 1e3)
        searches.append(search_ms)
    original = _original(name)
    assert result.plan is not None
    return {
        "problem": name,
        "steps": len(result.plan.steps),
        "makespan": round(result.plan.makespan, 2),
        "generated": result.generated,
        "visited": result.visited,
        "cpu_ms": round(min(times), 2),
        "plans_per_s": round(result.generated / min(searches) * 1e3),
        "original_steps": int(original["steps"]),
        "original_generated": int(original["plans_generated"]),
        "original_visited": int(original["plans_visited"]),
    }


def _original(name: str) -> dict[str, str]:
    with (DATA / "reference.csv").open() as lines:
        return next(row for row in csv.DictReader(lines) if row["problem"] == name and row["config"] == "22-g-mwloc")


def bytes_per_plan() -> float:
    """Memory per plan that a search for an unreachable goal holds after 20 000 generated plans."""
    limit, problem = 20_000, read(*texts("kitchen-s3"))
    endless = problem.with_goal("(and (holding cup1) (holding cup2))")  # one hand: no plan, no proof
    search = Search(problem.domain, endless, replace(MATCHING, node_limit=limit))
    gc.collect()
    tracemalloc.start()
    while search.counts[0] < limit - 100:  # the queue is dropped with the result: measure just before
        assert search.advance(CheckBudget(10)) is None
    gc.collect()
    memory, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return memory / search.counts[0]


def start_up_s(runs: int) -> float:
    """CPU time of the whole command `tailor plan` on soccer-p1: the best of several runs."""
    files = [str(DATA / "own" / f"{stem}.pddl") for stem in ("soccer-domain", "soccer-p1")]
    used_s = []
    for _ in range(runs):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(
            [sys.executable, "-P", "-m", "tailor.tools.main", "plan", *files], capture_output=True, check=True
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used_s.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return min(used_s)


def run(console: Console, quick: bool) -> None:
    """Print the table.

    Raises:
      NoMeasurement: The problems are not installed: they are test data.
    """
    table = Table(title="planning: CPU time with parsing and grounding; ref.: VHPOP 2.2.1", box=None)
    table.add_column("problem", no_wrap=True, min_width=19)
    for column in ("steps", "gen.", "vis.", "CPU ms", "plans/s", "ref. gen.", "ref. vis."):
        table.add_column(column, justify="right", no_wrap=True)
    measured = rows(quick)
    if not measured:
        raise NoMeasurement(f"no problems in {DATA / 'own'}, expected a checkout of the repository")
    for row in measured:
        keys = ("problem", "steps", "generated", "visited", "cpu_ms", "plans_per_s", "original_generated",
                "original_visited")  # fmt: skip
        table.add_row(*(str(row[key]) for key in keys))
    console.print(table)
    console.print(f"memory: {bytes_per_plan():.0f} bytes per generated plan")
    console.print(f"tailor plan on soccer-p1, from start to end: {start_up_s(1 if quick else 5):.2f} s of CPU")
