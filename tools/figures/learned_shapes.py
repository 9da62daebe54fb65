"""What a model has learned, as a shape: the paper's Figures 7 and 8, and a map of errors."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.asking import distilled_duration, space_of
from models.card import UNITS
from models.examples import Examples
from models.features import projective
from models.rules import NAMES, bounds, conditions, formula
from models.runtime import OnnxDuration, OnnxSuccess

Array = NDArray[np.float64]

DIST_M = 1.5  # Figure 7: straight ahead, standing still
AREA_M = 2.0  # Figure 8: half the side of the square around the goal
GRID = 121
HEADINGS = 24  # Figure 8 averages over where the robot looks at the start, as a picture of positions must


def figure7(figure: Any, model: OnnxDuration) -> None:
    """Predicted time (energy) over angle_at, in Cartesian and polar coordinates, with the rule of one segment."""
    angle, unit = np.linspace(-np.pi, np.pi, 361), UNITS[model.card["kind"]]
    zero = np.zeros_like(angle)
    arguments = np.stack([zero, zero, zero, zero, zero + DIST_M, zero, angle, zero], axis=1)
    mean, spread = model.predict(arguments)
    tree, _ = distilled_duration(model, np.random.default_rng(0))
    leaf = tree.splits.leaf_of(space_of(model.card)(arguments))
    left = figure.add_subplot(1, 2, 1)
    left.fill_between(np.degrees(angle), mean - spread, mean + spread, alpha=0.25, label="± spread")
    left.plot(np.degrees(angle), mean, label="model")
    left.plot(np.degrees(angle), tree.predict(space_of(model.card)(arguments)), lw=1, ls="--", label="its rules")
    left.set(
        xlabel="angle_at [°]", ylabel=f"{NAMES[unit]} [{unit}]", title=f"dist {DIST_M} m, angle_to 0°, v = v_g = 0"
    )
    left.legend()
    polar = figure.add_subplot(1, 2, 2, projection="polar")
    polar.plot(angle, mean)
    polar.set_title("the same, polar")
    quantities = space_of(model.card).features
    widest = int(np.bincount(leaf).argmax())
    box = next(box for box in bounds(tree.splits, len(quantities)) if box.leaf == widest)
    figure.supxlabel(
        f"if {conditions(box, quantities)}\n{NAMES[unit]} = {formula(tree, widest, quantities, unit)}", fontsize=7
    )


def figure8(figure: Any, model: OnnxSuccess) -> None:
    """Where an approach to a goal at the origin, heading right, is predicted to succeed, by place of the start."""
    line = np.linspace(-AREA_M, AREA_M, GRID)
    x, y = (grid.ravel() for grid in np.meshgrid(line, line))
    any_heading = np.mean([model.probability(_from(x, y, phi)) for phi in np.linspace(-np.pi, np.pi, HEADINGS)], axis=0)
    facing = model.probability(_from(x, y, np.arctan2(-y, -x)))
    for k, (name, values) in enumerate((("facing the goal", facing), ("any heading", any_heading)), start=1):
        axes = figure.add_subplot(1, 2, k, aspect="equal")
        shown = axes.pcolormesh(line, line, values.reshape(GRID, GRID), vmin=0, vmax=1, cmap="RdYlGn")
        axes.contour(line, line, values.reshape(GRID, GRID), [model.threshold], colors="black", linewidths=1)
        axes.annotate("", (0.35, 0), (0, 0), arrowprops={"arrowstyle": "->", "lw": 2})
        axes.set(xlabel="x [m]", ylabel="y [m]", title=f"start {name}")
    figure.colorbar(shown, label="predicted probability of success")


def _from(x: Array, y: Array, phi: Any) -> Array:
    rows = np.zeros((len(x), 8))
    rows[:, 0], rows[:, 1], rows[:, 2] = x, y, phi
    return rows


def error_by_region(figure: Any, model: OnnxDuration, rows: Examples) -> None:
    """Mean absolute error over distance and the two angles: where more episodes would help."""
    off = np.abs(model.predict(rows.arguments)[0] - rows.targets)
    _, _, dist, to, at = projective(rows.arguments).T
    pairs = ((np.degrees(to), "angle_to [°]", (0, 180)), (np.degrees(at), "angle_at [°]", (-180, 180)))
    for k, (angle, name, limits) in enumerate(pairs, start=1):
        axes = figure.add_subplot(1, 2, k)
        edges = np.linspace(0, dist.max(), 10), np.linspace(*limits, 13)
        total, _, _ = np.histogram2d(dist, angle, edges, weights=off)
        count, _, _ = np.histogram2d(dist, angle, edges)
        mean = np.where(count > 0, total / np.maximum(count, 1), np.nan)
        shown = axes.pcolormesh(*edges, mean.T, vmin=0, vmax=float(np.quantile(off, 0.95)))
        axes.set(xlabel="dist [m]", ylabel=name, title=f"mean |error| [{UNITS[model.card['kind']]}]")
    figure.colorbar(shown)
