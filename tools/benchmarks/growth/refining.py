"""Growth of refinement: gap to the best known choice against the number of free parameters."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tailor.executive.interfaces.models import Models
from tailor.executive.shell import DELIBERATION_NS
from tailor.models.runtime import load_robot
from tailor.tools.benchmarks.growth.curve import Curve
from tailor.tools.benchmarks.refinement.cases import LEGS, cases
from tailor.tools.benchmarks.refinement.refine import LONG_MS, QUICK_TASKS, TASKS, best_at
from tailor.tools.benchmarks.refinement.runners import ours
from tailor.tools.learning.fresh_seeds import fresh_seed

BUDGET_MS = DELIBERATION_NS / 1e6
LEAST_PCT = 0.01  # gaps are drawn on a logarithmic axis


def curves(quick: bool) -> Iterator[Curve]:
    """Mean gap of the chain solver over fresh tasks, after as much CPU time as a tick grants."""
    models = Models(*load_robot("agilo"))
    tasks = cases(models, QUICK_TASKS if quick else TASKS, fresh_seed("soccer").seed)
    points = []
    for name, legs in LEGS.items():
        gaps = []
        for seed, task in enumerate(tasks[name]):
            progress = ours("chain")(task.objective(models), task.starts, seed, LONG_MS)
            gaps.append(100.0 * (best_at(progress, BUDGET_MS) / best_at(progress, LONG_MS) - 1.0))
        points.append((2.0 * (legs - 1), max(LEAST_PCT, float(np.mean(gaps)))))
    yield Curve(f"gap after {BUDGET_MS:.0f} ms of refinement", "free parameters", "mean gap, %", points, 1.0)
