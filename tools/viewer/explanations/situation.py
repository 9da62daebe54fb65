"""What an action's duration model sees of a choice: its features (Table 7), which its rules speak of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.sequence import ActionSequence, InstantiatedAction
from tailor.models.cards.card import UNITS
from tailor.models.features.features import Quantity
from tailor.models.features.spaces import feature_spaces
from tailor.models.rules.leaf_rules import applied_rule


@dataclass(frozen=True, slots=True)
class Situation:
    """The features of one action, for the chosen and for the greedy values."""

    action: str
    features: tuple[Quantity, ...]
    chosen: tuple[float, ...]
    greedy: tuple[float, ...]
    rule: str = ""  # that applied to the chosen values; empty where the model's trees cannot be read


def situations_of(
    actions: Sequence[InstantiatedAction], chosen: ActionSequence, greedy: ActionSequence, models: Models
) -> tuple[Situation, ...]:
    """One for each action whose duration model's card names a feature space that is known here.

    Args:
      actions: Those within the horizon.
      chosen: The sequence with the chosen values bound.
      greedy: The sequence with greedy's values bound.
      models: The loaded models.
    """
    found = []
    for action in actions:
        model = models.durations[models.duration_path(action.action.duration_model, bool(action.context))]
        card, trees = getattr(model, "card", {}), getattr(getattr(model, "bounds", None), "trees", None)
        space = feature_spaces().get(card.get("features", ""))
        if space is not None:
            both = np.array([_parameters(action, sequence) for sequence in (chosen, greedy)])
            seen = space(action.action.arguments(both))
            rule = "" if trees is None else applied_rule(trees.boxes, seen[0], space.features, UNITS[card["kind"]])
            chose, alone = (tuple(row.astype(float)) for row in seen)
            found.append(Situation(action.action.name, space.features, chose, alone, rule))
    return tuple(found)


def _parameters(action: InstantiatedAction, sequence: ActionSequence) -> list[float]:
    """The action's parameters; NaN for what is still free."""
    values = [sequence.variables[i].value for i in action.variables]
    return [np.nan if value is None else value for value in values]
