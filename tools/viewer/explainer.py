"""Explanations for the page, with the models that a run's provenance names; silent where they are not to be had."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from tailor.executive.composition import rebuild_context
from tailor.executive.core.context import Context
from tailor.schemas.errors import Rejected, UsageError
from tailor.schemas.json_text import table_of
from tailor.schemas.messages import Subgoals
from tailor.tools.viewer.event_fields import Fields, number
from tailor.tools.viewer.explanations.explanation import Explanation, FreeParameter, explain
from tailor.tools.viewer.explanations.longer_search import best_cost

STREAM = 5  # of the seed, and the one after it; the executive's own draws come from others


class Explainer:
    """Explains the decisions of one executive."""

    def __init__(self, build_context: Callable[[Mapping[str, Any]], Context] = rebuild_context) -> None:
        """`build_context` makes a context of a provenance, or raises UsageError."""
        self._compose = build_context
        self._context: Context | None = None
        self.missing = "no provenance yet"  # why there are no explanations; empty when there are

    def learn(self, provenance: str) -> None:
        """Load what a provenance names; a failure is kept in `missing`."""
        try:
            table = table_of(provenance)
            if isinstance(table, Rejected):
                raise UsageError(f"provenance: {table.reason}")
            self._context = self._compose(table)
            self.missing = ""
        except (UsageError, KeyError, ValueError) as error:
            self._context = None
            self.missing = str(error)

    def explanation(self, message: Subgoals) -> Explanation | None:
        """Why these subgoals; None without models, or when nothing was free."""
        context = self._context
        if context is None:
            return None
        rng = np.random.default_rng([context.settings.seed, STREAM, message.tick])
        return explain(message, context.domain.actions, context.models, context.settings.refinement, rng)

    def best_cost(self, message: Subgoals) -> float:
        """The least objective that a long search finds for the same decision."""
        assert self._context is not None, "nothing was explained either"
        context = self._context
        rng = np.random.default_rng([context.settings.seed, STREAM + 1, message.tick])
        return best_cost(message, context.domain.actions, context.models, context.settings.refinement, rng)

    def fields(self, message: Subgoals) -> Fields | None:
        """The explanation as the page takes it."""
        explanation = self.explanation(message)
        return None if explanation is None else fields_of(explanation)


def fields_of(explanation: Explanation) -> Fields:
    """An explanation in JSON values; INVALID and unknown numbers are null."""
    return {
        "actions": list(explanation.actions),
        "chosen": [number(s) for s in explanation.chosen_s],
        "greedy": [number(s) for s in explanation.greedy_s],
        "cost": [number(explanation.chosen_cost), number(explanation.greedy_cost)],
        **(
            {"energy": [_numbers(explanation.chosen_j), _numbers(explanation.greedy_j)]} if explanation.chosen_j else {}
        ),
        "parameters": [_parameter(parameter) for parameter in explanation.parameters],
    }


def _numbers(values: Sequence[float]) -> list[float | None]:
    return [number(value) for value in values]


def _parameter(told: FreeParameter) -> Fields:
    variable, said = told.variable, told.alternatives
    return {
        "id": variable.id,
        "place": variable.label,
        "quantity": variable.quantity,
        "unit": variable.unit,
        "periodic": variable.periodic,
        "chosen": number(told.chosen),
        "greedy": number(told.greedy),
        "touched": list(told.touched),
        "values": [number(v) for v in said.values],
        "seconds": [[number(s) for s in said.durations_s[i]] for i in told.touched],  # the others do not change
        "total": [number(s) for s in said.durations_s.sum(axis=0)],
        "cost": [number(s) for s in said.total_s],
    }
