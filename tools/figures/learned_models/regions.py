"""Where in an action's space the pictures of its models look: a sweep for Figure 7, axes for a map of errors."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.models.cards.card import UNITS, Card
from tailor.models.episodes.examples import Examples
from tailor.models.features.features import FeatureSpace
from tailor.models.features.joints import joints, joints_friction
from tailor.models.features.planar import projective
from tailor.models.inference import OnnxDuration

DIST_M = 1.5  # Figure 7: straight ahead, standing still
STEP_RAD, ARRIVING_RAD_S = 0.7, 0.4  # its like for two joints: along the first, from rest
MIN_EPISODES = 3  # in a cell of the map: fewer are too few for a mean
CELLS = 9, 12  # distance, angle


@dataclass(frozen=True, slots=True)
class Region:
    """Arguments of a kind, as pictures show them."""

    space: FeatureSpace  # of distance and two angles, features 2 to 4
    swept: str  # name of the angle that Figure 7 turns
    fixed: str  # what stays
    unit: str  # of distance
    first_from_deg: float  # where the first angle begins


POSES = Region(projective, "angle_at", f"dist {DIST_M} m, angle_to 0°, v = v_g = 0", "m", 0.0)
JOINTS = Region(joints, "angle_2", f"dist {STEP_RAD} rad along a, v = 0, v_g = {ARRIVING_RAD_S} rad/s", "rad", -180.0)
GEARS = replace(JOINTS, space=joints_friction)  # friction is nominal


def region_of(card: Card) -> Region | None:
    """The region that fits a model's arguments; None where no picture is known for such arguments."""
    names = [argument["name"] for argument in card["arguments"]]
    return next((r for r in (POSES, JOINTS, GEARS) if [q.name for q in r.space.arguments] == names), None)


def swept(region: Region, angle: Array) -> Array:
    """Arguments of Figure 7, shape (n, k), for its angles (n,) in radians."""
    zero = np.zeros_like(angle)
    if region is POSES:
        return np.stack([zero, zero, zero, zero, zero + DIST_M, zero, angle, zero], axis=1)
    wa, wb = ARRIVING_RAD_S * np.cos(angle), ARRIVING_RAD_S * np.sin(angle)
    friction = [zero + 1.0] * (len(region.space.arguments) - 8)
    return np.stack([zero, zero, zero, zero, zero + STEP_RAD, wa, zero, wb, *friction], axis=1)


def error_by_region(figure: Any, model: OnnxDuration, rows: Examples, region: Region) -> None:
    """Mean absolute error over distance and the two angles: where more episodes would help."""
    off = np.abs(model.predict(rows.arguments)[0] - rows.targets)
    features = region.space(rows.arguments)
    dist, names = features[:, 2], [quantity.name for quantity in region.space.features[3:5]]
    top = float(np.quantile(off, 0.95))
    for k, (name, start) in enumerate(zip(names, (region.first_from_deg, -180.0), strict=True)):
        axes = figure.add_subplot(1, 2, k + 1)
        edges = np.linspace(0, dist.max(), CELLS[0] + 1), np.linspace(start, 180, CELLS[1] + 1)
        angle = np.degrees(features[:, 3 + k])
        total, _, _ = np.histogram2d(dist, angle, edges, weights=off)
        count, _, _ = np.histogram2d(dist, angle, edges)
        mean = np.where(count >= MIN_EPISODES, total / np.maximum(count, 1), np.nan)
        shown = axes.pcolormesh(*edges, mean.T, vmin=0, vmax=top)
        axes.set(xlabel=f"dist [{region.unit}]", ylabel=f"{name} [°]", yticks=np.arange(start, 181, 60))
    unit = UNITS[model.card["kind"]]
    label = f"mean |error| [{unit}] where fitted; white: < {MIN_EPISODES} episodes"
    figure.colorbar(shown, extend="max", label=label)
