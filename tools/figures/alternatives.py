"""The paper's Figure 11 from a recorded decision: predicted durations over a free parameter, each and summed."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from tailor.models.rules.rule_text import UNITLESS
from tailor.tools.figures.paths import COLOURS
from tailor.tools.figures.signed_degrees import count_both_ways
from tailor.tools.viewer.explanations.explanation import Explanation, FreeParameter

SIZE_IN = 2.9  # of one plot
SUM = "#2f8f6b"
LEGEND = "Seconds predicted. Full line: chosen. Dashed: greedy. Dotted: predicted to fail, or beyond the limit of risk."


def draw_alternatives(explanations: Sequence[tuple[str, Explanation]], path: Path) -> None:
    """Draw decisions into a PNG, one row for every free parameter: angles round, everything else flat.

    Args:
      explanations: Titles and explanations.
      path: Where to; its folder is made.
    """
    rows = [(title, explanation, free) for title, explanation in explanations for free in explanation.parameters]
    columns = max((len(free.touched) + 1 for _, _, free in rows), default=1)
    figure = Figure(figsize=(SIZE_IN * columns, SIZE_IN * max(1, len(rows)) + 0.4), layout="constrained")
    for row, (title, explanation, free) in enumerate(rows):
        for column, (name, seconds, chosen_s, colour) in enumerate(_curves(explanation, free)):
            place = row * columns + column + 1
            shape = {"projection": "polar"} if free.variable.periodic else {}
            axis = figure.add_subplot(len(rows), columns, place, **shape)
            _draw(axis, free, seconds, chosen_s, colour)
            head = f"{title}\n{free.variable.quantity} at {free.variable.label}\n" if column == 0 else "\n\n"
            axis.set_title(f"{head}{name}", fontsize="small", parse_math=False)
    figure.supxlabel(LEGEND, fontsize="small")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=120)


def _curves(explanation: Explanation, free: FreeParameter) -> list[tuple[str, Any, float, str]]:
    """Name, predictions over the range, that of the chosen values, and colour of each plot in a row."""
    seconds, chosen_s = free.alternatives.durations_s, explanation.chosen_s
    actions = [(explanation.actions[i], seconds[i], chosen_s[i], COLOURS[i % len(COLOURS)]) for i in free.touched]
    return [*actions, ("sum", seconds.sum(axis=0), sum(chosen_s), SUM)]


def _draw(axis: Any, free: FreeParameter, seconds: Any, chosen_s: float, colour: str) -> None:
    """One curve, pale where it is INVALID, with the chosen value (full line) and greedy's (dashed)."""
    values = free.alternatives.values
    valid = np.where(np.isfinite(free.alternatives.total_s), seconds, np.nan)
    axis.plot(values, seconds, color=colour, alpha=0.3, linewidth=1, linestyle=":")
    axis.plot(values, valid, color=colour, linewidth=1.8)
    if np.isfinite(seconds).any():  # a damaged message has anything
        axis.set_ylim(0, 1.08 * np.nanmax(seconds))
    for value, style in ((free.greedy, "--"), (free.chosen, "-")):
        axis.axvline(value, color="black" if style == "-" else "grey", linestyle=style, linewidth=1.1)
    axis.plot([free.chosen], [chosen_s], "o", color="black", markersize=4)
    unit = "" if free.variable.unit in UNITLESS else f" [{free.variable.unit}]"
    swept = "" if free.variable.periodic else f"{free.variable.quantity}{unit}, "
    axis.set_xlabel(f"{swept}chosen: {chosen_s:.1f} s", fontsize="small")
    if free.variable.periodic:
        count_both_ways(axis)
    else:
        axis.set_ylabel("time [s]", fontsize="small")
        axis.xaxis.set_major_locator(MaxNLocator(4))
    axis.yaxis.set_major_locator(MaxNLocator(4))
    axis.tick_params(labelsize="x-small")
