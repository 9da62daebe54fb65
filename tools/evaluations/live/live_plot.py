"""The plot of live against lock-step: every start's run among its lock-step runs, and the ratios with their mean."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from tailor.tools.evaluations.live.agreement import Starts, agreement
from tailor.tools.evaluations.pages.plots import ACCENT, INK, PALE, saved

COLOURS = (ACCENT, INK)


def draw_agreement(pairs: Mapping[str, Starts], margin_pct: float, path: Path) -> Path:
    """Draw into a PNG.

    Args:
      pairs: By name of the kind of run; the first is drawn start by start.
      margin_pct: Mean ratios within it do not matter.
    """
    figure = Figure(figsize=(12, 4.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    name, starts = next(iter(pairs.items()))
    order = np.argsort([r.mean() for r in starts.lockstep_s])
    for place, index in enumerate(order):
        repeats = starts.lockstep_s[index]
        left.plot([place] * len(repeats), repeats, "o", color=PALE, markersize=4)
        left.plot([place], [starts.run_s[index]], "D", color=ACCENT, markersize=6)
    left.plot([], [], "D", color=ACCENT, label=name)
    left.plot([], [], "o", color=PALE, label="lock-step, each with noise of its own")
    left.set(xlabel="start, by its mean duration", ylabel="duration (s)", ylim=(0, None), title="each start")
    left.xaxis.set_major_locator(MaxNLocator(integer=True))
    left.legend(frameon=False)
    right.axvspan(-margin_pct, margin_pct, color=PALE, alpha=0.4, label=f"margin ± {margin_pct:g} %")
    right.axvline(0, color=PALE)
    for number, (starts, colour) in enumerate(zip(pairs.values(), COLOURS, strict=True)):
        apart = 100 * np.expm1(starts.log_ratio)
        right.scatter(apart, np.full(len(apart), number + 0.12), s=18, color=colour, alpha=0.6)
        row = agreement(starts, margin_pct)
        mean, (low, high) = row["difference_pct"], row["ci95_pct"]
        right.errorbar([mean], [number - 0.12], xerr=[[mean - low], [high - mean]], fmt="o", color=colour, capsize=5)
    right.set_yticks(range(len(pairs)), [name.replace(", ", ",\n") for name in pairs])
    right.set(ylim=(-0.6, len(pairs) - 0.4), xlabel="longer than the start's mean in lock-step (%)")
    right.set_title("each start, and the mean with its 95 % interval")
    right.legend(frameon=False, loc="upper right")
    return saved(figure, path)
