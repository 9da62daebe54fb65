"""Whether runs of another kind are like lock-step's: each start's one run against the spread of its lock-step runs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import stats

from tailor.executive.interfaces.values import Array
from tailor.tools.evaluations.live.equivalence import equivalence
from tailor.tools.evaluations.outcome import Outcome
from tailor.tools.evaluations.paired_comparison import p_shown

NO_INTERVAL = {"ci95_pct": (math.nan, math.nan)}
UNKNOWN = (  # of fewer than two runs that achieved their goals
    "mean_lockstep_s", "mean_s", "difference_pct", "p_value", "p_rank", "p_equivalent", "within_range_pct",
    "within_range_expected_pct",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Starts:
    """Durations in seconds: one run a start, shape (n,), and lock-step's repeats, one array a start; all achieved."""

    seeds: tuple[int, ...]
    run_s: Array
    lockstep_s: tuple[Array, ...]

    @property
    def log_ratio(self) -> Array:
        """Log of each run's duration over the geometric mean of its start's lock-step runs, shape (n,).

        Durations have a long tail (a lost ball doubles an episode), so ratios are compared, as with Table 3.
        """
        return np.array([np.log(s) - np.log(r).mean() for s, r in zip(self.run_s, self.lockstep_s, strict=True)])

    @property
    def rank(self) -> Array:
        """Where each run stands among its start's lock-step runs, 0 (shortest) to 1, shape (n,); ties in the middle."""
        pairs = zip(self.run_s, self.lockstep_s, strict=True)
        return np.array([(np.sum(r < s) + 0.5 * np.sum(r == s) + 0.5) / (len(r) + 1) for s, r in pairs])


def starts_of(runs: Mapping[int, Outcome], repeats: Mapping[int, Sequence[Outcome]]) -> Starts:
    """Put the achieved runs together; starts without any are left out."""
    seeds, run_s, lockstep_s = [], [], []
    for seed in sorted(runs):
        reached = [round(outcome.duration_s, 1) for outcome in repeats[seed] if outcome.achieved]
        if runs[seed].achieved and reached:
            seeds.append(seed)
            run_s.append(round(runs[seed].duration_s, 1))  # to the tick, as in lock-step
            lockstep_s.append(np.array(reached))
    return Starts(tuple(seeds), np.array(run_s), tuple(lockstep_s))


def agreement(starts: Starts, margin_pct: float) -> dict[str, Any]:
    """The figures of a row; percentages are of durations, positive is longer than lock-step; NaN of fewer than two.

    `p_rank` is of the mean rank: were the runs lock-step's, every rank would be as likely, and as many as
    `within_range_expected_pct` says would be neither shorter nor longer than all lock-step runs of their start.
    """
    ratios, n = starts.log_ratio, len(starts.seeds)
    if n < 2:
        return {"n": n, "margin_pct": margin_pct, "equivalent": False, **dict.fromkeys(UNKNOWN, math.nan)} | NO_INTERVAL
    test = equivalence(np.zeros(n), ratios, float(np.log1p(margin_pct / 100)))
    deviation = (starts.rank.mean() - 0.5) * np.sqrt(12 * n)
    inside = [r.min() <= s <= r.max() for s, r in zip(starts.run_s, starts.lockstep_s, strict=True)]
    return {
        "n": n,
        "mean_lockstep_s": float(np.mean([r.mean() for r in starts.lockstep_s])),
        "mean_s": float(starts.run_s.mean()),
        "difference_pct": _percent(test.difference),
        "ci95_pct": (_percent(test.ci95[0]), _percent(test.ci95[1])),
        "p_value": test.p_different,
        "p_rank": float(2 * stats.norm.sf(abs(deviation))),
        "margin_pct": margin_pct,
        "p_equivalent": test.p_equivalent,
        "equivalent": test.p_equivalent < 0.05,
        "within_range_pct": 100 * float(np.mean(inside)),
        "within_range_expected_pct": 100 * float(np.mean([(len(r) - 1) / (len(r) + 1) for r in starts.lockstep_s])),
    }


def with_thresholds(row: Mapping[str, Any]) -> dict[str, Any]:
    """The row for a report: p-values below the threshold are not told apart."""
    return {name: p_shown(value) if name.startswith("p_") else value for name, value in row.items()}


def _percent(log_ratio: float) -> float:
    return 100 * float(np.expm1(log_ratio))
