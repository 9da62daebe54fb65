"""What an action costs at least while the free parameters of the subgoals before and after it lie in boxes.

Every displaced arrival is bounded by itself, every tree by the leaves that it can reach; a bag's spread from below by a
plane that touches it, and only what is sure to be too likely to fail counts as INVALID.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.action import unchanged
from tailor.executive.interfaces.models import ModelBounds
from tailor.executive.interfaces.values import Array, Columns, Spans
from tailor.executive.refinement.certificates.boxes import Boxes
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.objective.stage import Stage
from tailor.executive.refinement.solvers.chain import Link

FIXED, BEFORE, OWN = -1, 0, 1  # whose box a parameter comes from
AXES = {BEFORE: (slice(None), slice(None), None), OWN: (slice(None), None, slice(None))}  # ways, before, own


@dataclass(frozen=True, slots=True)
class NoBound:
    """Why nothing can be proven about an action."""

    reason: str


@dataclass(frozen=True, slots=True)
class StageBound:
    """The least cost of one stage over pairs of boxes."""

    stage: Stage
    link: Link
    settings: RefinementSettings
    owners: NDArray[np.intp]  # (p,) FIXED, BEFORE or OWN for each parameter of the action
    spans: Spans  # parameters to arguments
    duration: ModelBounds
    success: ModelBounds | None
    energy: ModelBounds | None

    @property
    def effort(self) -> int:
        """Elementary comparisons that one pair of boxes takes, roughly."""
        models = [model for model in (self.duration, self.success, self.energy) if model is not None]
        return self.stage.ways * sum(model.effort for model in models)

    def within(self, before: Boxes, own: Boxes) -> StageBound:
        """The same for boxes inside of these: quicker to compute."""
        arguments = self.spans(*self._parameters(before, own))
        asked = (self.duration, self.success, self.energy)
        duration, success, energy = (model and model.within(*arguments) for model in asked)
        assert duration is not None
        return replace(self, duration=duration, success=success, energy=energy)

    def least(self, before: Boxes, own: Boxes) -> Array:
        """Seconds, shape (len(before), len(own)): no values in the two boxes cost less; +inf: all are INVALID."""
        arguments = self.spans(*self._parameters(before, own))
        settings = self.settings
        cost = self.duration.lower_bound(*arguments, settings.k_std).mean(axis=0)
        if self.energy is not None:
            cost = cost + settings.energy_weight * self.energy.lower_bound(*arguments).mean(axis=0)
        if self.success is not None:
            failure = np.maximum(1 - self.success.upper_bound(*arguments), 0.0)
            cost = cost + settings.risk_cost_s * failure.mean(axis=0)
            cost = np.where(failure.max(axis=0) > self.stage.p_fail_max, np.inf, cost)
        return np.broadcast_to(cost, (len(before), len(own)))

    def _parameters(self, before: Boxes, own: Boxes) -> tuple[Columns, Columns]:
        """The action's parameters at both ends; each column broadcasts to (ways, before, own)."""
        sides = {
            BEFORE: self._ends(self.link.from_before, self.link.before, before),
            OWN: self._ends(~self.link.from_before, self.link.own, own),
        }
        ends: tuple[list[Array], list[Array]] = ([], [])
        for j, owner in enumerate(self.owners):
            side = BEFORE if owner == FIXED else owner
            some = slice(0, 1) if owner == FIXED else slice(None)
            for made, parameters in zip(ends, sides[side], strict=True):
                made.append(parameters[:, some, j][AXES[side]])
        return tuple(ends[0]), tuple(ends[1])

    def _ends(self, mine: NDArray[np.bool_], places: NDArray[np.intp], boxes: Boxes) -> tuple[Array, Array]:
        """All parameters at both ends of one side's boxes, shapes (ways, n, p); they rise with every free parameter."""
        values = np.vstack([boxes.lower, boxes.upper])
        rows = np.zeros((len(values), len(mine)))
        rows[:, mine] = values[:, places]
        parameters = self.stage.parameters(rows).reshape(-1, len(values), len(self.owners))
        return parameters[:, : len(boxes)], parameters[:, len(boxes) :]


def stage_bound(stage: Stage, link: Link, settings: RefinementSettings) -> StageBound | NoBound:
    """The bound of a stage, or why there is none."""
    action, models = stage.action, stage.models
    spans = _same if action.spans is None and action.arguments is unchanged else action.spans
    if spans is None:
        return NoBound(f"{action.name}: its models' arguments are not known as intervals")
    asked = (models.duration, models.success, models.energy)
    duration, success, energy = (_bounds(model) for model in asked)
    if duration is None or any(_bounds(model) is None for model in asked if model is not None):
        return NoBound(f"{action.name}: nothing is known of what is inside its models")
    owners = np.full(len(action.parameters), FIXED)
    owners[stage.slots] = np.where(link.from_before[stage.sources], BEFORE, OWN)
    return StageBound(stage, link, settings, owners, spans, duration, success, energy)


def _same(lower: Columns, upper: Columns) -> tuple[Columns, Columns]:
    """Arguments that are the parameters themselves."""
    return lower, upper


def _bounds(model: object) -> ModelBounds | None:
    """What a loaded model knows of its own bounds."""
    found: ModelBounds | None = getattr(model, "bounds", None)
    return found
