"""Plots in the reports on learned models: errors side by side, predictions against what happened."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.tools.cli.output_files import whole_output

mpl.use("Agg")
from matplotlib import pyplot as plt


def bars(path: Path, names: Sequence[str], errors: Sequence[float], intervals: Sequence[Sequence[float]]) -> Path:
    """MAE in seconds by name, with 95 % intervals."""
    figure, axes = plt.subplots(figsize=(1.6 + 1.3 * len(names), 3.6), layout="constrained")
    low, high = np.array(intervals).T
    axes.bar(names, errors, yerr=[errors - low, high - errors], capsize=4)
    axes.set_ylabel("MAE [s]")
    return saved(figure, path)


def scatter(path: Path, predicted: Mapping[str, Array], observed: Mapping[str, Array]) -> Path:
    """Predicted against observed seconds, one panel a name."""
    figure, panels = _panels(len(predicted))
    for axes, name in zip(panels, predicted, strict=True):
        limit = axis_end(observed[name])
        axes.scatter(predicted[name], observed[name], s=4, alpha=0.4)
        axes.plot([0, limit], [0, limit], color="black", lw=1)
        axes.set(title=name, xlabel="predicted [s]", ylabel="observed [s]", xlim=(0, limit), ylim=(0, limit))
    return saved(figure, path)


def against_features(path: Path, columns: Mapping[str, Array], seconds: Array) -> Path:
    """Time against one feature of each space, as in the lower graphs of the paper's Figure 6 b."""
    figure, panels = _panels(len(columns))
    for axes, (name, values) in zip(panels, columns.items(), strict=True):
        axes.scatter(values, seconds, s=3, alpha=0.3)
        axes.set(xlabel=name, ylabel="time [s]")
    return saved(figure, path)


def _panels(count: int) -> tuple[Any, Any]:
    figure, panels = plt.subplots(1, count, figsize=(3.8 * count, 3.6), layout="constrained", squeeze=False)
    return figure, panels[0]


def axis_end(values: Array) -> float:
    """End of an axis from 0 that shows all these values, shape (n,), but the largest of two hundred."""
    return 1.05 * float(np.quantile(values, 0.995))


def saved(figure: Any, path: Path) -> Path:
    """Write a figure and close it; returns the path."""
    with whole_output(path) as whole:
        figure.savefig(whole, dpi=110)
    plt.close(figure)
    return path
