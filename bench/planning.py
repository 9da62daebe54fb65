"""How the planner does on the project's own problems, beside the original VHPOP's counts; and what a plan weighs.

`python -m bench.planning [--json]`. Times are CPU milliseconds of the best of several runs, parsing and grounding
included; the original's are from tests/data/pddl/reference.csv (its 3.0, configuration g-mwloc).
"""

from __future__ import annotations

import argparse
import csv
import gc
import json
import time
import tracemalloc
from dataclasses import replace
from pathlib import Path

from executive.budget import CheckBudget
from executive.planning import MATCHING, Problem, Result, Search, parse_domain, parse_problem

DATA = Path(__file__).parents[1] / "tests" / "data" / "pddl"
UNLIMITED = 10**9  # checks
RUNS = 7


def names() -> list[str]:
    return sorted(path.stem for path in (DATA / "own").glob("*.pddl") if not path.stem.endswith("-domain"))


def texts(name: str) -> tuple[str, str]:
    """PDDL of domain and problem."""
    folder = DATA / "own"
    return (folder / f"{name.rsplit('-', 1)[0]}-domain.pddl").read_text(), (folder / f"{name}.pddl").read_text()


def plan(domain_text: str, problem_text: str) -> tuple[Result, float]:
    """The result and the CPU milliseconds of its search alone, grounding included."""
    problem = read(domain_text, problem_text)
    started = time.process_time()
    result = Search(problem.domain, problem, MATCHING).advance(CheckBudget(UNLIMITED))
    assert result is not None
    return result, (time.process_time() - started) * 1e3


def read(domain_text: str, problem_text: str) -> Problem:
    return parse_problem(problem_text, parse_domain(domain_text))


def rows(quick: bool = False) -> list[dict[str, object]]:
    """One row for each problem."""
    return [_row(name, 2 if quick else RUNS) for name in names()]


def _row(name: str, runs: int) -> dict[str, object]:
    given = texts(name)
    times = []
    searches = []
    for _ in range(runs):
        started = time.process_time()
        result, search_ms = plan(*given)
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
        return next(row for row in csv.DictReader(lines) if row["problem"] == name and row["config"] == "g-mwloc")


def bytes_per_plan(name: str = "kitchen-s3", limit: int = 20_000) -> float:
    """The memory that a search holds after `limit` generated plans, per plan; the goal is made unreachable in time."""
    problem = read(*texts(name))
    endless = problem.with_goal("(and (holding cup1) (holding cup2))")  # one hand: no plan, no proof
    search = Search(problem.domain, endless, replace(MATCHING, node_limit=limit))
    gc.collect()
    tracemalloc.start()
    while search.counts[0] < limit - 100:  # the queue is dropped with the result: measure just before
        assert search.advance(CheckBudget(10)) is None
    gc.collect()
    held, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return held / search.counts[0]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="fewer runs a problem")
    parser.add_argument("--json", action="store_true", help="rows as JSON")
    arguments = parser.parse_args()
    table = rows(arguments.quick)
    if arguments.json:
        print(json.dumps(table, indent=1))
        return
    print(f"{'problem':<22}{'steps':>6}{'generated':>11}{'visited':>9}{'CPU ms':>8}{'plans/s':>9}   original's")
    for row in table:
        counts = f"{row['steps']:>6}{row['generated']:>11}{row['visited']:>9}{row['cpu_ms']:>8}{row['plans_per_s']:>9}"
        original = f"{row['original_steps']:>4}{row['original_generated']:>8}{row['original_visited']:>7}"
        print(f"{row['problem']:<22}{counts}   {original}")
    print(f"memory: {bytes_per_plan():.0f} bytes per generated plan")


if __name__ == "__main__":
    main()
