"""Baselines of an improvement: the oracle's greedy choice, all zeros, the ceiling, and the bias of predictions.

An improvement over a poor greedy choice looks large; the ceiling puts it into proportion.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from tailor.tools.evaluations.oracles.grid import Oracle
from tailor.tools.evaluations.outcome import Outcome
from tailor.tools.evaluations.paired_comparison import ratio_interval

Outcomes = Mapping[int, Outcome]  # by seed
UNKNOWN = ("oracle_pct", "oracle_again_pct", "refined_same_starts_pct")  # of no start


def against_oracle(judged: Sequence[Oracle], greedy: Outcomes, refined: Outcomes) -> dict[str, Any]:
    """Baselines over the starts that the oracle simulated: mean durations, and improvements over the greedy model.

    `oracle_pct` is of the fastest simulated runs (the ceiling), which is biased by noise; `oracle_again_pct` is of the
    same choices with other noise. `share_of_oracle_pct` is of the sums of seconds; its interval is a bootstrap over
    starts.
    """
    usable = [o for o in judged if np.isfinite(o.ceiling_s) and greedy[o.seed].achieved and refined[o.seed].achieved]
    greedy_s = np.array([greedy[o.seed].duration_s for o in usable])
    refined_s = np.array([refined[o.seed].duration_s for o in usable])
    ceiling_s = np.minimum([o.ceiling_s for o in usable], np.minimum(greedy_s, refined_s))
    again_s = np.array([o.again_s for o in usable])
    if not usable:  # that none of the starts is done both ways is a result, too
        return {"oracle_n": 0, **dict.fromkeys(UNKNOWN, math.nan)}
    possible_s = float((greedy_s - ceiling_s).sum())
    return {
        "oracle_n": len(usable),
        "oracle_pct": 100 * float(np.mean(1 - ceiling_s / greedy_s)),
        "oracle_again_pct": 100 * float(np.nanmean(1 - again_s / greedy_s)) if np.isfinite(again_s).any() else np.nan,
        "refined_same_starts_pct": 100 * float(np.mean(1 - refined_s / greedy_s)),
        "share_of_oracle_pct": 100 * float((greedy_s - refined_s).sum()) / possible_s if possible_s else math.nan,
        "share_of_oracle_ci95": ratio_interval(100 * (greedy_s - refined_s), greedy_s - ceiling_s),
        "oracle_s": float(ceiling_s.mean()),
        "oracle_again_s": _mean(again_s),
        "refined_same_starts_s": float(refined_s.mean()),
        "greedy_same_starts_s": float(greedy_s.mean()),
        "oracle_greedy_s": float(np.mean([o.greedy_s for o in usable])),
        "zero_s": _mean(np.array([o.zero_s for o in usable])),
    }


def bias_s(outcomes: Iterable[Outcome]) -> float:
    """Mean of predicted minus actual duration over all successful actions."""
    errors = [
        predicted - actual
        for outcome in outcomes
        for predicted, actual, how in zip(outcome.predicted_s, outcome.actual_s, outcome.outcomes, strict=True)
        if how == "done"
    ]
    return float(np.mean(errors)) if errors else float("nan")


def _mean(seconds: np.ndarray) -> float:
    """Mean of the finite values."""
    return float(np.nanmean(seconds)) if np.isfinite(seconds).any() else float("nan")
