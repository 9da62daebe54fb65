"""What a model has learned, as a shape: the paper's Figures 7 and 8."""

from __future__ import annotations

from textwrap import wrap
from typing import Any

import numpy as np
from matplotlib.ticker import MaxNLocator

from tailor.executive.interfaces.values import Array
from tailor.models.cards.card import UNITS
from tailor.models.inference import OnnxDuration, OnnxSuccess
from tailor.models.rules.model_queries import distilled_duration, space_of
from tailor.models.rules.rule_text import QUANTITY_NAMES, conditions, formula, leaf_boxes
from tailor.tools.figures.learned_models.regions import Region, swept
from tailor.tools.figures.signed_degrees import count_both_ways

WIDEST = 150  # characters of a rule on one line
AREA_M = 2.0  # Figure 8: half the side of the square around the goal
GRID = 121
HEADINGS = 24  # Figure 8 averages over where the robot looks at the start, as a picture of positions must


def figure7(figure: Any, model: OnnxDuration, region: Region) -> None:
    """Predicted time (energy) over one angle, in Cartesian and polar coordinates, with the rule of one segment."""
    angle, unit = np.linspace(-np.pi, np.pi, 361), UNITS[model.card["kind"]]
    space, arguments = space_of(model.card), swept(region, angle)
    mean, spread = model.predict(arguments)
    tree, _ = distilled_duration(model, np.random.default_rng(0))
    leaf, rules = tree.splits.leaf_of(space(arguments)), tree.predict(space(arguments))
    widest = int(np.bincount(leaf).argmax())
    left, degrees = figure.add_subplot(1, 2, 1), np.degrees(angle)
    left.fill_between(degrees, mean - spread, mean + spread, alpha=0.25, label="± spread")
    left.plot(degrees, mean, label="model")
    left.plot(degrees, rules, lw=1, ls="--", color="tab:orange", label="its rules")
    left.plot(degrees, np.where(leaf == widest, rules, np.nan), lw=3, color="tab:orange", label="rule below")
    left.set(xlabel=f"{region.swept} [°]", ylabel=f"{QUANTITY_NAMES[unit]} [{unit}]", xticks=range(-180, 181, 60))
    left.set_title(region.fixed, fontsize="medium")
    left.legend(fontsize="small")
    polar = figure.add_subplot(1, 2, 2, projection="polar")
    polar.plot(angle, mean)
    count_both_ways(polar)
    polar.yaxis.set_major_locator(MaxNLocator(4))
    polar.set(ylim=(0, None), rlabel_position=112)
    polar.set_title(f"the same, {QUANTITY_NAMES[unit]} [{unit}] outwards", fontsize="medium")
    box = next(box for box in leaf_boxes(tree.splits, len(space.features)) if box.leaf == widest)
    lines = (
        f"if {conditions(box, space.features)}",
        f"{QUANTITY_NAMES[unit]} = {formula(tree, widest, space.features, unit)}",
    )
    figure.supxlabel("\n".join(line for part in lines for line in wrap(part, WIDEST)), fontsize=7)


def figure8(figure: Any, model: OnnxSuccess) -> None:
    """Where an approach to a goal at the origin, heading right, is predicted to succeed, by place of the start."""
    line = np.linspace(-AREA_M, AREA_M, GRID)
    x, y = (grid.ravel() for grid in np.meshgrid(line, line))
    any_heading = np.mean([model.probability(_from(x, y, phi)) for phi in np.linspace(-np.pi, np.pi, HEADINGS)], axis=0)
    facing = model.probability(_from(x, y, np.arctan2(-y, -x)))
    for k, (name, values) in enumerate((("facing the goal", facing), ("any heading", any_heading)), start=1):
        axes = figure.add_subplot(1, 2, k, aspect="equal")
        shown = axes.pcolormesh(line, line, values.reshape(GRID, GRID), vmin=0, vmax=1, cmap="RdYlBu")
        axes.contour(line, line, values.reshape(GRID, GRID), [model.threshold], colors="black", linewidths=1)
        axes.annotate("", (0.35, 0), (0, 0), arrowprops={"arrowstyle": "->", "lw": 2})
        axes.set(xlabel="x [m]", ylabel="y [m]", title=f"start {name}")
    figure.colorbar(shown, label=f"predicted probability of success; line: threshold {model.threshold:g}")


def _from(x: Array, y: Array, phi: Any) -> Array:
    rows = np.zeros((len(x), 8))
    rows[:, 0], rows[:, 1], rows[:, 2] = x, y, phi
    return rows
