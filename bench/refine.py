"""How fast the solvers come close to the optimum: gap to the best known against milliseconds, on one core.

Chain solver, the paper's genetic algorithm and our differential evolution beside scipy's and, where installed, CMA-ES;
all call the same objective: sequences of AGILO with its learned models. `python -m bench.refine [--quick] [--json]`.
"""

from __future__ import annotations

import argparse
import json

import numpy as np

from bench.refine_cases import Case, cases
from bench.refine_runners import Found, ours, runners
from executive.library import Models
from models.runtime import load_robot

MOMENTS_MS = (5, 20, 60, 80)
LONG_MS = 1500  # the search for the best known value


def rows(quick: bool = False) -> list[dict[str, object]]:
    """One row for each case and solver: mean gap in percent at each moment, and the worst of all tasks."""
    models = Models(*load_robot("agilo"))
    table = []
    for name, tasks in cases(models, 2 if quick else 5).items():
        races = [_race(task, models, seed) for seed, task in enumerate(tasks)]
        table += [_row(name, solver, [race[solver] for race in races]) for solver in races[0]]
    return table


def _race(task: Case, models: Models, seed: int) -> dict[str, list[float]]:
    """By solver, the gap to the best known value at each moment, in percent."""
    limit_ms = MOMENTS_MS[-1]
    found = {name: run(task.objective(models), task.starts, seed, limit_ms) for name, run in runners()}
    long = [ours("chain")(task.objective(models), task.starts, 100 + again, LONG_MS) for again in range(2)]
    best = min(_at(one, LONG_MS) for one in [*long, *found.values()])
    return {name: [100 * (_at(one, moment) / best - 1) for moment in MOMENTS_MS] for name, one in found.items()}


def _row(case: str, solver: str, gaps: list[list[float]]) -> dict[str, object]:
    means = zip(MOMENTS_MS, np.mean(gaps, axis=0), strict=True)
    worst = zip(MOMENTS_MS, np.max(gaps, axis=0), strict=True)
    return {
        "case": case,
        "solver": solver,
        "n": len(gaps),
        **{f"gap_pct_at_{moment}_ms": round(float(gap), 3) for moment, gap in means},
        **{f"worst_pct_at_{moment}_ms": round(float(gap), 3) for moment, gap in worst},
    }


def _at(found: Found, moment_ms: float) -> float:
    return min((value for at, value in found if at <= moment_ms), default=float("inf"))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="fewer sequences a case")
    parser.add_argument("--json", action="store_true", help="rows as JSON")
    arguments = parser.parse_args()
    table = rows(arguments.quick)
    if arguments.json:
        print(json.dumps(table, indent=1))
        return
    print(f"{'case':<16}{'solver':<30}" + "".join(f"{f'{m} ms':>10}" for m in MOMENTS_MS) + f"{'worst@60':>10}")
    for row in table:
        gaps = "".join(f"{row[f'gap_pct_at_{m}_ms']:>9.2f}%" for m in MOMENTS_MS)
        print(f"{row['case']:<16}{row['solver']:<30}{gaps}{row['worst_pct_at_60_ms']:>9.2f}%")


if __name__ == "__main__":
    main()
