"""Columns of a table that compares two settings from the same starts: time, and every other cost, with paired tests."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from tailor.tools.evaluations.costs import Costs
from tailor.tools.evaluations.oracles.baselines import bias_s
from tailor.tools.evaluations.outcome import Outcome
from tailor.tools.evaluations.paired_comparison import (
    MIN_UNITS,
    Comparison,
    Difference,
    Units,
    compare,
    compare_means,
    compare_shares,
    p_shown,
    ratio_interval,
    sums_by_unit,
    without_intervals,
)

Named = Sequence[tuple[str, float]]  # costs by name
Start = tuple[str, int]  # scenario, seed
Pair = tuple[Outcome, Outcome]  # from one start: the baseline, and the setting that is judged
MAX_MORE_POINTS = 0.5  # of failures or contacts, that count as no more


def columns(pairs: Mapping[Start, Pair], unit: str = "start") -> dict[str, Any]:
    """Columns of a row.

    Durations, arrivals and energy are of the pairs in which both achieved the goal by acting; failures, contacts and
    costs of this robot alone are of all. Over fewer than MIN_UNITS scenarios there are neither intervals nor p-values.
    Where fewer than two units are left to compare, durations are NaN: that nearly all fail is a result, too.

    Args:
      pairs: Outcomes by start.
      unit: "start", or "scenario": the starts of a scenario are one unit.
    """
    kept = {start: pair for start, pair in pairs.items() if pair[0].is_timed and pair[1].is_timed}
    units = None if unit == "start" else [scenario for scenario, _ in kept]
    every = None if unit == "start" else [scenario for scenario, _ in pairs]
    both = list(kept.values())
    times = _times(both, units)
    row = {
        "n": times.n,
        "unit": unit,
        "units": times.units,
        "mean_greedy_s": times.mean_baseline_s,
        "mean_refined_s": times.mean_s,
        **times.verdict,
        **_of_total(both, units),
        "failed": sum(not (first.achieved and second.achieved) for first, second in pairs.values()),
        **_shares("failures_pct", pairs.values(), every, lambda outcome: not outcome.achieved),
        **_shares("contacts_pct", pairs.values(), every, lambda outcome: outcome.costs.contacts > 0),
        **_means("energy_j", both, units, lambda outcome: outcome.costs.energy_j),
        **_each("arrival_", both, units, lambda costs: costs.arrival),
        **_each("", list(pairs.values()), every, lambda costs: costs.further),
        "bias_greedy_s": bias_s(pair[0] for pair in both),
        "bias_refined_s": bias_s(pair[1] for pair in both),
    }
    return row if unit == "start" or times.units >= MIN_UNITS else without_intervals(row)


def _times(pairs: Sequence[Pair], units: Units | None) -> Comparison:
    count = len(pairs if units is None else set(units))
    if count < 2:
        unknown = math.nan
        return Comparison(len(pairs), count, unknown, unknown, unknown, (unknown, unknown), unknown, unknown, unknown)
    return compare([greedy.duration_s for greedy, _ in pairs], [refined.duration_s for _, refined in pairs], units)


def _of_total(pairs: Sequence[Pair], units: Units | None) -> dict[str, Any]:
    """Seconds gained as a share of all seconds of the baseline, in percent; the interval is a bootstrap over units."""
    greedy_s, gained_s = (
        sums_by_unit(np.array(seconds), units)
        for seconds in ([a.duration_s for a, _ in pairs], [a.duration_s - b.duration_s for a, b in pairs])
    )
    known = len(greedy_s) > 1
    return {
        "total_pct": 100 * float(gained_s.sum() / greedy_s.sum()) if known else math.nan,
        "total_ci95": ratio_interval(100 * gained_s, greedy_s) if known else (math.nan, math.nan),
    }


def is_better(row: Mapping[str, Any]) -> bool:
    """Whether a row is faster (95 %) at no more failures and contacts; of one without an interval only the latter."""
    return ("ci95" not in row or row["ci95"][0] > 0) and costs_no_more(row)


def costs_no_more(row: Mapping[str, Any]) -> bool:
    """Whether a row's failures and contacts are at most MAX_MORE_POINTS above the baseline's."""
    return all(
        row[f"{cost}_refined"] - row[f"{cost}_greedy"] <= MAX_MORE_POINTS for cost in ("failures_pct", "contacts_pct")
    )


def _each(prefix: str, pairs: Sequence[Pair], units: Units | None, named: Callable[[Costs], Named]) -> dict[str, Any]:
    """Columns of each of the costs that only some robots or actions have."""

    def cost(name: str, outcome: Outcome) -> float:
        return dict(named(outcome.costs)).get(name, math.nan)

    found: dict[str, Any] = {}
    for name in sorted({name for pair in pairs for outcome in pair for name, _ in named(outcome.costs)}):
        found |= _means(f"{prefix}{name}", pairs, units, partial(cost, name))
    return found


def _means(name: str, pairs: Sequence[Pair], units: Units | None, cost: Callable[[Outcome], float]) -> dict[str, Any]:
    first, second = (np.array([cost(pair[side]) for pair in pairs]) for side in (0, 1))
    known = np.isfinite(first) & np.isfinite(second)
    if not known.any():
        return {}
    kept = None if units is None else [unit for unit, there in zip(units, known, strict=True) if there]
    return _shown(name, compare_means(first[known], second[known], kept))


def _shares(name: str, pairs: Any, units: Units | None, happened: Callable[[Outcome], bool]) -> dict[str, Any]:
    first, second = (np.array([happened(pair[side]) for pair in pairs]) for side in (0, 1))
    return _shown(name, compare_shares(first, second, units))


def _shown(name: str, difference: Difference) -> dict[str, Any]:
    return {
        f"{name}_greedy": difference.first,
        f"{name}_refined": difference.second,
        f"{name}_more_ci95": difference.ci95,
        f"{name}_p": p_shown(difference.p_value),
    }
