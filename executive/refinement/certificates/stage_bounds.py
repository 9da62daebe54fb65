"""Lower bound on the cost of an action over boxes of the free parameters of the subgoals before and after it.

Each displaced arrival is bounded separately, each tree by its reachable leaves, the std of a bag by a tangent plane.
Boxes count as INVALID only if every choice in them fails too probably.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.action import unchanged
from tailor.executive.interfaces.models import ModelBounds
from tailor.executive.interfaces.values import Array, Columns, Spans
from tailor.executive.refinement.certificates.boxes import Boxes
from tailor.executive.refinement.certificates.pair_bounds import PairBounds, unknown
from tailor.executive.refinement.objective.context_success import ContextBounds
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.objective.stage import Stage
from tailor.executive.refinement.solvers.chain_structure import Link

FIXED, BEFORE, OWN = -1, 0, 1  # owner of a parameter: no box, the box before, the own box
Duration = tuple[Array, Mapping[int, Array]]  # in the middle of each pair of boxes, and slopes by argument: (n, 1)


@dataclass(frozen=True, slots=True)
class NoBound:
    """Reason why an action has no lower bound."""

    reason: str


@dataclass(frozen=True, slots=True)
class ArgumentBoxes:
    """Boxes of a model's arguments, one column each, that broadcast to (n_arrivals, n, 1).

    `radius` is half of each parameter's range before it was displaced; it broadcasts to (1, n, 1).
    """

    lower: Columns
    upper: Columns
    radius: Columns


@dataclass(frozen=True, slots=True)
class StageBound:
    """Lower bound on the cost of one stage over pairs of boxes."""

    stage: Stage
    link: Link
    settings: RefinementSettings
    owners: NDArray[np.intp]  # (p,) FIXED, BEFORE or OWN for each parameter of the action
    places: NDArray[np.intp]  # (p,) column of the parameter in the boxes of its owner
    spans: Spans  # parameters to arguments
    duration: ModelBounds
    success: ModelBounds | None
    energy: ModelBounds | None

    @property
    def effort(self) -> int:
        """Approximate number of elementary comparisons for one pair of boxes."""
        models = [model for model in (self.success, self.energy) if model is not None]
        duration = self.duration.effort * (1 if self.is_linear else self.stage.n_arrivals)
        return duration + self.stage.n_arrivals * sum(model.effort for model in models)

    @property
    def is_linear(self) -> bool:
        """Whether the bound on the duration is linear in the parameters."""
        return self.duration.is_linear and self.spans is _identity

    def within(self, before: Boxes, own: Boxes) -> StageBound:
        """The bound restricted to boxes inside the given ones: faster to compute.

        A linear bound of the duration stays as it is, so that the actions of one model can be bounded in one call.
        """
        arguments = self.spans(*self._parameters(before, own))
        success, energy = (model and model.within(*arguments) for model in (self.success, self.energy))
        duration = self.duration if self.is_linear else self.duration.within(*arguments)
        return replace(self, duration=duration, success=success, energy=energy)

    def arguments(self, before: Boxes, own: Boxes) -> ArgumentBoxes:
        """Model arguments for n boxes of the subgoal before, each with the own box of the same index."""
        return ArgumentBoxes(*self.spans(*self._parameters(before, own)), self._radius(before, own))

    def pair_bounds(self, before: Boxes, own: Boxes, arguments: ArgumentBoxes, duration: Duration) -> PairBounds:
        """Lower bounds in seconds, given those of the duration; +inf: all values in the two boxes are INVALID."""
        bounds = unknown((len(own),), before, own, self.is_linear)
        cost, slopes = duration
        for j, slope in slopes.items():
            if self.owners[j] != FIXED and bounds.slopes is not None:
                bounds.slopes[self.owners[j]][:, self.places[j]] += slope[:, 0]
        ends = arguments.lower, arguments.upper
        if self.energy is not None:
            cost = cost + self.settings.energy_weight * self.energy.lower_bound(*ends).mean(axis=0)
        if self.success is not None:
            failure = np.maximum(1 - self.success.upper_bound(*ends), 0.0)
            cost = cost + self._least_price(failure, ends)
            cost = np.where(failure.max(axis=0) > self.stage.p_fail_max, np.inf, cost)
        bounds.middle[:] = cost[:, 0]
        return bounds

    def _least_price(self, failure: Array, arguments: tuple[Columns, Columns]) -> Array:
        """Least expected price of failures; one that meets an object has a price of its own."""
        price: Array
        if not isinstance(self.success, ContextBounds):
            price = self.settings.risk_cost_s * failure.mean(axis=0)
            return price
        own, met = (np.maximum(1 - bound, 0.0) for bound in self.success.upper_bounds(*arguments))
        price = self.settings.risk_cost_s * own.mean(axis=0) + self.stage.context_cost_s * met.mean(axis=0)
        return price

    def _parameters(self, before: Boxes, own: Boxes) -> tuple[Columns, Columns]:
        """Lower and upper ends of the action's parameters; each column broadcasts to (n_arrivals, n, 1)."""
        sides = {
            BEFORE: self._ends(self.link.from_before, self.link.before, before),
            OWN: self._ends(~self.link.from_before, self.link.own, own),
        }
        ends: tuple[list[Array], list[Array]] = ([], [])
        for j, owner in enumerate(self.owners):
            side = BEFORE if owner == FIXED else owner
            boxes = slice(0, 1) if owner == FIXED else slice(None)
            for columns, parameters in zip(ends, sides[side], strict=True):
                columns.append(parameters[:, boxes, j, None])
        return tuple(ends[0]), tuple(ends[1])

    def _radius(self, before: Boxes, own: Boxes) -> Columns:
        """Half of each parameter's range, as the columns of `_parameters`, of one arrival."""
        radii = {BEFORE: before.radius, OWN: own.radius}
        owners = zip(self.owners.tolist(), self.places, strict=True)
        return tuple(
            np.zeros((1, 1, 1)) if owner == FIXED else radii[owner][None, :, place, None] for owner, place in owners
        )

    def _ends(self, mask: NDArray[np.bool_], indices: NDArray[np.intp], boxes: Boxes) -> tuple[Array, Array]:
        """All parameters at both ends of one side's boxes, shapes (n_arrivals, n, p).

        Every action parameter is monotonic in the free parameters, so the ends of a box are its bounds.
        """
        values = np.vstack([boxes.lower, boxes.upper])
        samples = np.zeros((len(values), len(mask)))
        samples[:, mask] = values[:, indices]
        parameters = self.stage.parameters(samples).reshape(-1, len(values), len(self.owners))
        return parameters[:, : len(boxes)], parameters[:, len(boxes) :]


def stage_bound(stage: Stage, link: Link, settings: RefinementSettings) -> StageBound | NoBound:
    """Lower bound of a stage, or the reason why there is none."""
    action, models = stage.action, stage.models
    spans = _identity if action.spans is None and action.arguments is unchanged else action.spans
    if spans is None:
        return NoBound(f"{action.name}: its model arguments are not available as intervals")
    used = (models.duration, models.success, models.energy)
    duration, success, energy = (_bounds(model) for model in used)
    if duration is None or any(_bounds(model) is None for model in used if model is not None):
        return NoBound(f"{action.name}: its models have no bounds")
    owners = np.full(len(action.parameters), FIXED)
    owners[stage.slots] = np.where(link.from_before[stage.sources], BEFORE, OWN)
    columns = np.empty(len(link.from_before), dtype=np.intp)
    columns[link.from_before], columns[~link.from_before] = link.before, link.own
    places = np.zeros(len(owners), dtype=np.intp)
    places[stage.slots] = columns[stage.sources]
    return StageBound(stage, link, settings, owners, places, spans, duration, success, energy)


def _identity(lower: Columns, upper: Columns) -> tuple[Columns, Columns]:
    """Model arguments that equal the parameters."""
    return lower, upper


def _bounds(model: object) -> ModelBounds | None:
    """Bounds of a loaded model; None if it has none."""
    bounds: ModelBounds | None = getattr(model, "bounds", None)
    return bounds
