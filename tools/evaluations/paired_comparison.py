"""Paired comparisons of two settings over the same starts: intervals over independent units, tests, shares.

A unit is what was drawn independently: a start, or a whole scenario when several are judged together. The pairs of one
unit count as one value, their mean.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import stats

from tailor.executive.interfaces.values import Array
from tailor.schemas.errors import UsageError

Units = Sequence[str | int]
P_THRESHOLD = 0.001  # smaller ones are no further evidence
RESAMPLES = 2000
SAME = 1e-9  # share by which equal differences of seconds may differ, as their sums are rounded
DIGITS = 6  # of the differences whose ranks are tested: rounding errors would rank those that are equal
MIN_RESAMPLED = 10  # units of a bootstrap: of three the 95 % interval holds the truth in 75 % of cases, of ten in 91 %
MIN_ALIKE = 6  # values without spread that tell anything: by the sign test, 2^(1-5) is more than 5 %
MIN_UNITS = 3  # the t-interval over two is 12.7 standard errors wide either way, whatever happened within each


@dataclass(frozen=True, slots=True)
class Comparison:
    """Durations under two settings. Percentages are of the baseline; positive improvement is faster."""

    n: int  # pairs
    units: int
    mean_baseline_s: float
    mean_s: float
    improvement_pct: float  # mean over pairs of 1 - t / t_baseline (paper 6.3)
    ci95: tuple[float, float]  # of the improvement, in percent
    p_value: float  # dependent t-test, two-sided
    p_wilcoxon: float
    slower_pct: float  # share of pairs that took longer

    @property
    def verdict(self) -> dict[str, Any]:
        """Columns of a table about the improvement, in order."""
        return {
            "improvement_pct": self.improvement_pct,
            "ci95": self.ci95,
            "p_value": p_shown(self.p_value),
            "p_wilcoxon": p_shown(self.p_wilcoxon),
            "slower_pct": self.slower_pct,
        }


@dataclass(frozen=True, slots=True)
class Difference:
    """A cost under two settings, and the difference, second minus first."""

    first: float
    second: float
    ci95: tuple[float, float]  # of the difference
    p_value: float


def compare(baseline_s: ArrayLike, refined_s: ArrayLike, units: Units | None = None) -> Comparison:
    """Compare durations in seconds.

    Args:
      baseline_s: Of the baseline, shape (n,), n >= 2.
      refined_s: From the same starts, shape (n,).
      units: Unit of each pair; None: every pair is one.

    Raises:
      UsageError: Fewer than two units.
      ValueError: Different lengths.
    """
    first, second = _paired(baseline_s, refined_s)
    ratio = 1 - second / first
    ratios, firsts, seconds = (by_unit(values, units) for values in (ratio, first, second))
    if len(ratios) < 2:
        raise UsageError(f"{len(ratios)} episodes to compare, expected two that end well both ways: more --episodes")
    low, high = mean_interval(ratios)
    return Comparison(
        len(first),
        len(ratios),
        float(first.mean()),
        float(second.mean()),
        100 * float(ratios.mean()),
        (100 * low, 100 * high),
        _dependent_t_test(firsts, seconds),
        _rank_test(firsts, seconds),
        100 * float(np.mean(is_longer(second, first))),
    )


def compare_means(first: ArrayLike, second: ArrayLike, units: Units | None = None) -> Difference:
    """Compare a cost of at least two units by the dependent t-test; shapes (n,)."""
    one, other = (by_unit(values, units) for values in _paired(first, second))
    return Difference(float(one.mean()), float(other.mean()), mean_interval(other - one), _dependent_t_test(one, other))


def compare_shares(first: ArrayLike, second: ArrayLike, units: Units | None = None) -> Difference:
    """Compare how often something happened, in percent, by McNemar's exact test; boolean, shapes (n,).

    The interval is the adjusted Wald interval of Bonett and Price (2012). Where units of several pairs differ, both are
    those of `compare_means` over the units' shares.
    """
    one, other = (by_unit(values, units) for values in _paired(first, second))
    if units is not None and (one != other).any():
        return compare_means(100 * one, 100 * other)
    n, lost, gained = len(one), int(np.sum(one > other)), int(np.sum(other > one))
    p_value = float(stats.binomtest(gained, lost + gained).pvalue) if lost + gained else 1.0
    p10, p01 = (lost + 1) / (n + 2), (gained + 1) / (n + 2)
    half = float(stats.norm.ppf(0.975)) * np.sqrt((p10 + p01 - (p01 - p10) ** 2) / (n + 2))
    interval = (100 * float(p01 - p10 - half), 100 * float(p01 - p10 + half))
    return Difference(100 * float(one.mean()), 100 * float(other.mean()), interval, p_value)


def is_longer(some_s: Array, than_s: Array) -> NDArray[np.bool_]:
    """Where durations are longer by more than rounding: of equal ticks the difference depends on when they began."""
    return np.round(some_s - than_s, DIGITS) > 0


def by_unit(values: Array, units: Units | None) -> Array:
    """Mean of each unit's values, in the order of first appearance; the values themselves without units."""
    if units is None:
        return values
    names = np.array(units)
    return np.array([values[names == name].mean() for name in dict.fromkeys(units)])


def sums_by_unit(values: Array, units: Units | None) -> Array:
    """Sum of each unit's values, as `by_unit`: of a total, a unit with more of them has a larger share."""
    return values if units is None else by_unit(values, units) * [units.count(name) for name in dict.fromkeys(units)]


def mean_interval(values: Array) -> tuple[float, float]:
    """95 % t-interval of the mean of independent values, shape (n,); infinite where these tell nothing.

    That of a few without any spread would be empty, however few they are: see MIN_ALIKE.
    """
    if len(values) < 2 or (len(values) < MIN_ALIKE and np.ptp(values) <= SAME * np.abs(values).max()):
        return -np.inf, np.inf
    half = float(stats.t.ppf(0.975, len(values) - 1) * stats.sem(values))
    return float(values.mean()) - half, float(values.mean()) + half


def ratio_interval(parts: Array, wholes: Array, seed: int = 0) -> tuple[float, float]:
    """95 % bootstrap interval over units of sum(parts) / sum(wholes); shapes (n,). Resamples are drawn with the seed.

    NaN for fewer than MIN_RESAMPLED units, or if all wholes are 0; resamples whose wholes are 0 are left out.
    """
    if len(parts) < MIN_RESAMPLED or not wholes.any():
        return math.nan, math.nan
    drawn = np.random.default_rng(seed).integers(len(parts), size=(RESAMPLES, len(parts)))
    sums = wholes[drawn].sum(axis=1)
    low, high = np.quantile(parts[drawn].sum(axis=1)[sums != 0.0] / sums[sums != 0.0], bootstrap_tails(len(parts)))
    return float(low), float(high)


def mean_over_runs(values: Array, runs: Units, seed: int) -> tuple[float, tuple[float, float]]:
    """Mean of one value an episode, shape (n,), and its 95 % bootstrap interval over runs; see `ratio_interval`."""
    _, run = np.unique(runs, return_inverse=True)
    sums, counts = (np.bincount(run, some).astype(np.float64) for some in (values, np.ones(len(values))))
    return float(values.mean()), ratio_interval(sums, counts, seed)


def bootstrap_tails(n: int) -> tuple[float, float]:
    """Quantiles of the resamples of n >= 2 units between which a 95 % interval lies.

    Those of the expanded percentile interval (Hesterberg 2015). Resamples spread less than samples do, by the root of
    (n - 1) / n, and like a normal distribution, not t: with 2.5 % a side that of ten held the truth in 87 % of cases.
    """
    tail = float(stats.norm.cdf(stats.t.ppf(0.025, n - 1) * np.sqrt(n / (n - 1))))
    return tail, 1 - tail


def share_interval(count: int, n: int) -> tuple[float, float]:
    """Wilson's 95 % interval of a share, in percent."""
    if n == 0:
        return 0.0, 100.0
    interval = stats.binomtest(count, n).proportion_ci(0.95, method="wilson")
    return 100 * float(interval.low), 100 * float(interval.high)


def without_intervals(row: Mapping[str, Any]) -> dict[str, Any]:
    """The columns of a row but those that conclude from its units to others: intervals and p-values."""
    return {name: value for name, value in row.items() if not (name.startswith("p_") or name.endswith(("ci95", "_p")))}


def p_shown(p_value: float) -> float | str:
    """A p-value for a table: three decimals, or that it is below the threshold."""
    return f"< {P_THRESHOLD}" if p_value < P_THRESHOLD else round(p_value, 3)


def _dependent_t_test(first: Array, second: Array) -> float:
    """Its p-value, two-sided; where all differences are one and the same, as of ticks, that of the sign test.

    Without any spread t is infinite, however few they are.
    """
    apart = second - first
    if len(apart) < 2 or not apart.any():
        return 1.0
    if np.ptp(apart) <= SAME * np.abs(apart).max():
        return float(2.0 ** (1 - len(apart)))
    return float(stats.ttest_rel(first, second).pvalue)


def _rank_test(first: Array, second: Array) -> float:
    """P-value of Wilcoxon's signed-rank test, two-sided; of few pairs with ties its approximation may be below any."""
    apart = np.round(second - first, DIGITS)
    count = np.count_nonzero(apart)
    return max(float(stats.wilcoxon(apart).pvalue), float(2.0 ** (1 - count))) if count else 1.0


def _paired(first: ArrayLike, second: ArrayLike) -> tuple[Array, Array]:
    one, other = np.asarray(first, dtype=np.float64), np.asarray(second, dtype=np.float64)
    if one.shape != other.shape:
        raise ValueError(f"{one.shape} against {other.shape} values, expected as many")
    return one, other
