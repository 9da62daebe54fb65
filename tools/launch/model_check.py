"""Checks at start-up that the loaded models are all that a domain's actions need: a tick would find out while armed."""

from __future__ import annotations

from tailor.executive.deliberation.context import Context
from tailor.executive.refinement.objective.sequence import InstantiatedAction
from tailor.executive.refinement.objective.stage_models import models_of
from tailor.schemas.errors import UsageError


def check_models(context: Context) -> None:
    """Raise UsageError, naming action and model, if an action needs a model that is not loaded.

    Which ones are needed depends on the settings, too: energy counts only where it has a weight.
    """
    missing = []
    for action in context.domain.actions.values():
        try:
            models_of(InstantiatedAction(action, 0, ()), context.models, context.settings.refinement)
        except UsageError as error:
            missing.append(str(error))
    if missing:
        raise UsageError("; ".join(missing))
