"""Models of one action, looked up by the names that the action gives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.models import DurationModel, Models, SuccessModel
from tailor.executive.refinement.objective.context_success import ContextSuccess
from tailor.executive.refinement.objective.sequence import InstantiatedAction
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.errors import UsageError


@dataclass(frozen=True, slots=True)
class StageModels:
    """Models of one action; None if the action has none of the kind."""

    duration: DurationModel
    success: SuccessModel | None
    energy: DurationModel | None


def models_of(instance: InstantiatedAction, models: Models, settings: RefinementSettings) -> StageModels:
    """Models that an action names; the energy model only if energy has a weight.

    Raises:
      UsageError: A named model is not loaded.
    """
    action, context = instance.action, instance.action.context
    energy_path = action.duration_model.rpartition("/")[0] + "/energy" if settings.energy_weight > 0 else ""
    required = [(action.duration_model, models.durations), (energy_path, models.durations)]
    beside_path = context.success_model if context is not None else ""
    for path, loaded in [*required, (action.success_model, models.successes), (beside_path, models.successes)]:
        if path and path not in loaded:
            known = ", ".join(sorted(loaded)) or "none"
            raise UsageError(f"action {action.name} needs the model {path}, expected one of those loaded: {known}")
    success = models.successes[action.success_model] if action.success_model else None
    if instance.context and context is not None:
        rows = np.array(instance.context)
        success = ContextSuccess(success, models.successes[beside_path], rows, context.may_meet)
    energy = models.durations[energy_path] if energy_path else None
    duration_path = models.duration_path(action.duration_model, bool(instance.context))
    return StageModels(models.durations[duration_path], success, energy)
