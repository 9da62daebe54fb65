"""The plot of live against lock-step: each start a dot, and how far apart two runs of a start are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from tools.evaluations.equivalence import equivalence
from tools.evaluations.plots import ACCENT, INK, PALE

COLOURS = (ACCENT, INK)


def draw_agreement(pairs: Mapping[str, tuple[Sequence[float], Sequence[float]]], margin_s: float, path: Path) -> Path:
    """Draw durations into a PNG.

    Args:
      pairs: By name of the run: lock-step's durations and its own, in seconds.
      margin_s: Differences of means within it do not matter.
    """
    figure = Figure(figsize=(10, 4.4), layout="constrained")
    left, right = figure.subplots(1, 2)
    top = 1.05 * max(max(*first, *second) for first, second in pairs.values())
    left.plot([0, top], [0, top], color=PALE, zorder=0)
    right.axvspan(-margin_s, margin_s, color=PALE, alpha=0.4, label=f"margin ± {margin_s:.2f} s")
    right.axvline(0, color=PALE)
    for number, ((name, (first, second)), colour) in enumerate(zip(pairs.items(), COLOURS, strict=True)):
        left.scatter(first, second, s=22, color=colour, alpha=0.7, label=name)
        said = equivalence(first, second, margin_s)
        apart = np.subtract(second, first)
        right.scatter(apart, np.full(len(apart), number) + 0.12, s=18, color=colour, alpha=0.6)
        error = [[said.difference - said.ci95[0]], [said.ci95[1] - said.difference]]
        right.errorbar([said.difference], [number - 0.12], xerr=error, fmt="o", color=colour, capsize=5)
    left.set(xlabel="lock-step (s)", ylabel="the other run (s)", xlim=(0, top), ylim=(0, top), title="duration")
    left.legend(frameon=False)
    right.set_yticks(range(len(pairs)), list(pairs))
    right.set(ylim=(-0.6, len(pairs) - 0.4), xlabel="seconds longer than lock-step from the same start")
    right.set_title("each start, and the mean with its 95 % interval")
    right.legend(frameon=False, loc="upper right")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)
    return path
