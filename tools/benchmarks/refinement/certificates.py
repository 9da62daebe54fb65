"""CPU time of a proof that a choice is within 5 % and 1 % of the models' optimum."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from rich.console import Console
from rich.table import Column, Table

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.certificates.certificate import Certificate, certificate
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.selection import solver_for
from tailor.tools.benchmarks.refinement.cases import Case

GAPS_PCT = (5.0, 1.0)
LIMIT_S = 2.0
MIN_MISSED_PCT = 0.1  # a smaller gain of the proof does not count as missed by the search
SETTINGS = RefinementSettings(certify_checks=10**6)


@dataclass(frozen=True, slots=True)
class Proof:
    """CPU milliseconds until each of GAPS_PCT was proven, inf if it was not; the last gap; the longest check.

    `missed_pct` is the gain of the best choice that the proof found: the amount by which the search missed it.
    """

    until_ms: tuple[float, ...]
    gap_pct: float
    longest_ms: float
    missed_pct: float


def rows(models: Models, tasks: dict[str, list[Case]]) -> list[dict[str, object]]:
    """One row for each case."""
    return [_row(name, [proof(case, models) for case in cases]) for name, cases in tasks.items()]


def proof(case: Case, models: Models) -> Proof:
    """Search for a choice, then prove its optimality gap."""
    objective = case.objective(models, SETTINGS)
    solver = solver_for(objective, SETTINGS, np.random.default_rng(0), objective.vectors(case.starts))
    solver.advance(CheckBudget(SETTINGS.checks_max))
    assert solver.best is not None, "the cases have valid choices"
    proven = certificate(objective, solver.best, SETTINGS)
    assert isinstance(proven, Certificate), "AGILO's models have bounds"
    until, longest = dict.fromkeys(GAPS_PCT, np.inf), 0.0
    began = before = time.process_time()
    while not proven.finished and before - began < LIMIT_S:
        proven.advance(CheckBudget(1))
        now = time.process_time()
        longest, before = max(longest, now - before), now
        for gap in GAPS_PCT:
            if proven.gap_pct is not None and proven.gap_pct <= gap + 1e-6:
                until[gap] = min(until[gap], 1e3 * (now - began))
    gap_pct = proven.gap_pct if proven.gap_pct is not None else np.inf
    return Proof(tuple(until.values()), gap_pct, 1e3 * longest, 100 * (solver.value / proven.value - 1))


def _row(case: str, proofs: Sequence[Proof]) -> dict[str, object]:
    until = np.median([one.until_ms for one in proofs], axis=0)
    reached = np.mean([np.isfinite(one.until_ms) for one in proofs], axis=0)
    return {
        "case": case,
        "n": len(proofs),
        **{f"median_ms_to_{gap:g}_pct": float(ms) for gap, ms in zip(GAPS_PCT, until, strict=True)},
        **{f"share_within_{gap:g}_pct": float(share) for gap, share in zip(GAPS_PCT, reached, strict=True)},
        "median_gap_pct": float(np.median([one.gap_pct for one in proofs])),
        "worst_gap_pct": float(np.max([one.gap_pct for one in proofs])),
        "share_missed": float(np.mean([one.missed_pct > MIN_MISSED_PCT for one in proofs])),
        "worst_missed_pct": float(np.max([one.missed_pct for one in proofs])),
        "longest_check_ms": float(np.max([one.longest_ms for one in proofs])),
    }


def show(console: Console, models: Models, tasks: dict[str, list[Case]]) -> None:
    """Print the table."""
    table = Table(
        Column("case", no_wrap=True),
        title="certificate: median CPU ms until 5 % and 1 % are proven, gap in % after 2 s, longest check in ms",
        caption="proven: tasks within 1 %; missed: tasks whose optimum the search missed, by at most so many %",
        box=None,
        padding=(0, 1, 0, 0),
    )
    for name in ("5 %", "1 %", "proven", "gap", "worst", "missed", "by", "check"):
        table.add_column(name, justify="right", no_wrap=True)
    for row in rows(models, tasks):
        ms = [_milliseconds(row[f"median_ms_to_{gap:g}_pct"]) for gap in GAPS_PCT]
        shares = [f"{row[name]:.0%}" for name in ("share_within_1_pct", "share_missed")]
        gap, worst, missed, longest = (
            f"{row[name]:.1f}" for name in ("median_gap_pct", "worst_gap_pct", "worst_missed_pct", "longest_check_ms")
        )
        cells = (*ms, shares[0], gap, worst, shares[1], missed, longest)
        table.add_row(str(row["case"]), *cells)
    console.print(table)


def _milliseconds(value: object) -> str:
    return f"{value:.0f}" if isinstance(value, float) and np.isfinite(value) else "—"
