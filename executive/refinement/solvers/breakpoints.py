"""Where the cost of a pose sequence has its edges: tree thresholds and kinks of features, by free parameter.

Between them the cost of model trees is affine in the free parameters, so that its minimum lies on the grid that they
span (paper 6.2.1). That holds while positions are known and only headings and speeds are free; else a reason is given.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.ranges import Ranges
from tailor.executive.refinement.objective.sequence import InstantiatedAction, Variable
from tailor.executive.refinement.objective.settings import RefinementSettings

POSE = ("x", "y", "phi", "v", "xg", "yg", "phig", "vg")  # what models of pose actions take, in this order
NUDGE = 2e-6  # of a range: from a threshold to either side of it, well above single precision
ALIKE = 1e-9


@dataclass(frozen=True, slots=True)
class TreeEdges:
    """The thresholds of an action's trees by feature of Table 7: v, v_g, dist, angle_to, angle_at.

    `clipped` says that leaves are clipped to the range seen in them, which makes them more than one plane each.
    """

    thresholds: Mapping[str, Sequence[float]]
    clipped: bool = False


@dataclass(frozen=True, slots=True)
class NotAnalytic:
    """Why the minimum cannot be read off a grid."""

    reason: str


def breakpoints(
    actions: Sequence[InstantiatedAction],
    variables: tuple[Variable, ...],
    objective: SequenceObjective,
    edges: Mapping[str, TreeEdges],
    settings: RefinementSettings,
) -> tuple[Array, ...] | NotAnalytic:
    """For each free parameter of the objective the values between which the cost is affine, on both sides of each edge.

    Args:
      actions: The actions of the objective.
      variables: Their table.
      objective: Gives the order of the free parameters.
      edges: Thresholds by executable action name, of duration and success trees together.
      settings: With a spread term or displaced arrivals the cost is not affine between edges.
    """
    if settings.k_std > 0:
        return NotAnalytic("the spread of a bag (k_std) is not piecewise linear")
    if settings.arrival_spread:
        return NotAnalytic("displaced arrivals move every threshold")
    found: dict[int, list[float]] = {identifier: [] for identifier in objective.ids}
    for instance in actions:
        reason = _refusal(instance, variables, edges)
        if reason:
            return NotAnalytic(f"{instance.action.name}: {reason}")
        for identifier, values in _edges(instance, variables, edges[instance.action.name]):
            if identifier in found:
                found[identifier].extend(values)
    columns = range(len(objective.ids))
    return tuple(_both_sides(found[i], objective.ranges, k) for i, k in zip(objective.ids, columns, strict=True))


def _refusal(instance: InstantiatedAction, variables: tuple[Variable, ...], edges: Mapping[str, TreeEdges]) -> str:
    """Why this action is not of the kind, or ""."""
    action = instance.action
    if action.name not in edges:
        return "its model is no tree"
    if edges[action.name].clipped:
        return "leaves are clipped, and a sum of clipped planes can have its minimum inside a cell"
    if tuple(parameter.name for parameter in action.parameters) != POSE:
        return "it does not go from a pose to a pose"
    middle = [(v.lower + v.upper) / 2 for v in (variables[i] for i in instance.variables)]
    given = np.array([middle, middle]) + np.array([[0.0], [0.1]])
    if not np.allclose(action.arguments(given), given, atol=ALIKE):
        return "its models do not take its parameters as they are"
    for name in ("x", "y", "xg", "yg"):
        if variables[instance.variables[POSE.index(name)]].free:
            return f"{name} is free, and distance is not linear in it"
    return ""


def _edges(
    instance: InstantiatedAction, variables: tuple[Variable, ...], tree: TreeEdges
) -> Iterable[tuple[int, list[float]]]:
    """Edges by variable id; the angles from the line of sight, whose direction is known."""
    ids = dict(zip(POSE, instance.variables, strict=True))
    x, y, xg, yg = (variables[ids[name]].lower for name in ("x", "y", "xg", "yg"))
    sight = float(np.arctan2(yg - y, xg - x))
    at = tree.thresholds
    yield ids["v"], list(at.get("v", ()))
    yield ids["vg"], list(at.get("v_g", ()))
    turned = [sign * float(t) for t in at.get("angle_to", ()) for sign in (1, -1)]
    yield ids["phi"], [sight + angle for angle in (0.0, np.pi, *turned)]
    arrived = [sign * float(t) for t in at.get("angle_at", ()) for sign in (1, -1)]
    yield ids["phig"], [sight + angle for angle in (np.pi, *arrived)]


def _both_sides(values: list[float], ranges: Ranges, column: int) -> Array:
    """The edges that lie in the range, each from below and from above, and the ends of the range; sorted."""
    lower, upper, width = ranges.lower[column], ranges.upper[column], ranges.width[column]
    wanted = np.array(values, dtype=np.float64)
    angles = wanted + 2 * np.pi * np.arange(-1, 2)[:, None] if ranges.periodic[column] else wanted[None]
    inside = angles[(angles > lower) & (angles < upper)]
    nudge = NUDGE * width
    known = np.sort(np.clip(np.concatenate([[lower, upper], inside - nudge, inside + nudge]), lower, upper))
    distinct: Array = known[np.concatenate([[True], known[1:] != known[:-1]])]  # np.unique loads numpy.ma, 40 ms
    return distinct
