"""Paired comparison of durations as in the paper's Table 3, with intervals and a rank test."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import stats

from tailor.schemas.errors import UsageError

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Comparison:
    """Two settings over the same starts. Percentages are of the baseline; positive improvement is faster."""

    n: int
    mean_baseline_s: float
    mean_s: float
    improvement_pct: float  # mean over episodes of 1 - t / t_baseline (paper 6.3)
    ci95: tuple[float, float]  # of the improvement, in percent
    p_value: float  # dependent t-test, two-sided
    p_wilcoxon: float
    slower_pct: float  # share of episodes that took longer

    @property
    def verdict(self) -> dict[str, Any]:
        """Columns of a table about the improvement, in order."""
        return {
            name: getattr(self, name) for name in ("improvement_pct", "ci95", "p_value", "p_wilcoxon", "slower_pct")
        }

    @property
    def gain_of_means_pct(self) -> float:
        """Improvement of the mean durations; less sensitive to short episodes than the mean of ratios."""
        return 100 * (1 - self.mean_s / self.mean_baseline_s)


def compare(baseline_s: ArrayLike, refined_s: ArrayLike) -> Comparison:
    """Compare durations in seconds of the same starts, both of shape (n,), n >= 2.

    Raises:
      UsageError: Fewer than two pairs.
      ValueError: Different lengths.
    """
    first, second = np.asarray(baseline_s, dtype=np.float64), np.asarray(refined_s, dtype=np.float64)
    if first.shape != second.shape:
        raise ValueError(f"{first.shape} against {second.shape} durations, expected as many")
    if len(first) < 2:
        raise UsageError(f"{len(first)} episodes to compare, expected two that end well both ways: more --episodes")
    ratio = 1 - second / first
    mean = float(ratio.mean())
    half = float(stats.t.ppf(0.975, len(ratio) - 1) * stats.sem(ratio))
    same = bool(np.all(first == second))
    return Comparison(
        len(first),
        float(first.mean()),
        float(second.mean()),
        100 * mean,
        (100 * (mean - half), 100 * (mean + half)),
        1.0 if same else float(stats.ttest_rel(first, second).pvalue),
        1.0 if same else float(stats.wilcoxon(first, second).pvalue),
        100 * float(np.mean(second > first)),
    )


def share_interval(count: int, n: int) -> tuple[float, float]:
    """Wilson's 95 % interval of a share, in percent."""
    if n == 0:
        return 0.0, 100.0
    interval = stats.binomtest(count, n).proportion_ci(0.95, method="wilson")
    return 100 * float(interval.low), 100 * float(interval.high)
