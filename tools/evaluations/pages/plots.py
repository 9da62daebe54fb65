"""Plots of the evaluations' pages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from tailor.tools.cli.output_files import whole_output

INK, ACCENT, PALE = "#2c3e50", "#2f8f6b", "#b8c4cc"


def draw_pairs(greedy_s: Sequence[float], refined_s: Sequence[float], path: Path) -> Path:
    """Scatter plot of greedy and refined durations, and histogram of the improvement."""
    figure = Figure(figsize=(9, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    top = 1.05 * max([*greedy_s, *refined_s], default=1.0)
    left.plot([0, top], [0, top], color=PALE)
    left.scatter(greedy_s, refined_s, s=9, color=INK, alpha=0.6)
    left.set(xlabel="greedy (s)", ylabel="refined (s)", xlim=(0, top), ylim=(0, top), title="duration of an episode")
    gain = 100 * (1 - np.asarray(refined_s) / np.asarray(greedy_s))
    right.hist(gain, bins=40, color=PALE)
    right.set(xlabel="improvement (%)", ylabel="episodes", title="improvement of an episode")
    if len(gain):
        right.axvline(float(gain.mean()), color=ACCENT, label=f"mean {gain.mean():.1f} %")
        right.legend(frameon=False)
    return saved(figure, path)


def draw_shares(row: dict[str, Any], path: Path) -> Path:
    """Success of approaches without and with assertion, and the confusion matrix."""
    figure = Figure(figsize=(9, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    left.bar(
        ["as they are", "with assertion"], [row["success_before_pct"], row["success_after_pct"]], color=[PALE, ACCENT]
    )
    left.set(ylabel="approaches that succeed (%)", ylim=(0, 100))
    fields = [
        [row[f"predicted_{predicted}_observed_{observed}_pct"] for observed in ("fail", "success")]
        for predicted in ("fail", "success")
    ]
    right.imshow(fields, cmap="Greens", vmin=0, vmax=100)
    right.set_xticks([0, 1], ["observed: fail", "success"])
    right.set_yticks([0, 1], ["predicted: fail", "success"])
    for i, line in enumerate(fields):
        for j, share in enumerate(line):
            right.text(j, i, f"{share:.1f} %", ha="center", va="center")
    return saved(figure, path)


def saved(figure: Figure, path: Path) -> Path:
    """Save a figure as a PNG, whose folder is made."""
    with whole_output(path) as whole:
        figure.savefig(whole, dpi=110)
    return path


def draw_curves(curves: Mapping[str, Sequence[tuple[float, float, float, float]]], path: Path) -> Path:
    """Learning curves with intervals: by name, points of episodes, improvement, and the ends of its interval."""
    figure = Figure(figsize=(7, 4.2), layout="constrained")
    axis = figure.subplots()
    for (name, points), colour in zip(curves.items(), (INK, ACCENT, "#b5651d", "#7a5195"), strict=False):
        x, y, low, high = (np.array(column) for column in zip(*points, strict=True))
        axis.plot(x, y, marker="o", color=colour, label=name)
        axis.fill_between(x, low, high, color=colour, alpha=0.15)
    axis.axhline(0, color=PALE)
    axis.set(xscale="log", xlabel="episodes of each action", ylabel="improvement by refinement (%)")
    places = sorted({point[0] for points in curves.values() for point in points})
    axis.set_xticks(places, [f"{x:g}" for x in places])
    axis.minorticks_off()
    axis.legend(frameon=False)
    return saved(figure, path)
