"""Explains decisions with the models that a run's provenance names; without them there are no explanations."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cache, lru_cache
from typing import Any

import numpy as np

from tailor.executive.composition import ModelLoader, rebuild_context
from tailor.executive.deliberation.context import Context
from tailor.executive.robot_models import load_models
from tailor.schemas.errors import Rejected, UsageError
from tailor.schemas.messages import Contexts, Subgoals
from tailor.schemas.parsed_files import table_of
from tailor.tools.lockstep.blame import blamed_on_run
from tailor.tools.viewer.event_fields import Fields, number
from tailor.tools.viewer.explanations.avoided_failure import AvoidedFailure
from tailor.tools.viewer.explanations.decided_sequence import decided
from tailor.tools.viewer.explanations.explanation import Explanation, FreeParameter, explain
from tailor.tools.viewer.explanations.longer_search import best_cost

STREAM = 5  # of the seed, and the next one; the executive draws from others


class Explainer:
    """Explains the decisions of one executive.

    Attributes:
      missing: Why there are no explanations; empty if there are.
    """

    def __init__(self, build_context: Callable[[Mapping[str, Any]], Context] | None = None) -> None:
        """`build_context` makes a context from a provenance, or raises UsageError; None: from the installed models."""
        self._build_context = lru_cache(maxsize=8)(self._parsed)  # by provenance: runs may alternate in a recording
        self._rebuild = build_context or self._rebuilt
        self._hashes: Any = None  # of the loaded models
        self._load: ModelLoader = load_models
        self._context: Context | None = None
        self._objects: Contexts | None = None  # the newest
        self.missing = "no provenance yet"

    def load(self, provenance: str) -> None:
        """Load domain and models that a provenance names; `missing` keeps the reason of a failure."""
        try:
            self._context = self._build_context(provenance)
            self.missing = ""
        except (UsageError, KeyError, ValueError) as error:
            self._context = None
            self.missing = str(error)

    def _parsed(self, provenance: str) -> Context:
        table = table_of(provenance)
        if isinstance(table, Rejected):
            raise UsageError(f"provenance: {table.reason}")
        return self._rebuild(table)

    def _rebuilt(self, provenance: Mapping[str, Any]) -> Context:
        """The context; models are loaded once, until a provenance names others."""
        if provenance.get("models") != self._hashes:
            self._hashes, self._load = provenance.get("models"), cache(load_models)
        return rebuild_context(provenance, self._load)

    def note(self, objects: Contexts) -> None:
        """Keep the objects of the subgoals that have the same tick."""
        self._objects = objects

    def explanation(self, message: Subgoals) -> Explanation | None:
        """Explanation of subgoals; None without models, if no parameter was free, or if the message is damaged."""
        context = self._context
        if context is None or message.tick < 0:
            return None
        with blamed_on_run(context.domain.name):
            settings = context.settings.refinement
            found = decided(message, context.domain.actions, context.models, settings, self._objects)
            return None if found is None else explain(found, _rng(context, STREAM, message))

    def best_cost(self, message: Subgoals, explanation: Explanation) -> float:
        """Least objective that a long search finds for the decision of a message, whose explanation is given."""
        assert self._context is not None, "there is an explanation"
        return best_cost(explanation.decided, _rng(self._context, STREAM + 1, message))

    def fields(self, message: Subgoals) -> Fields | None:
        """The explanation as the page reads it; None also if the models do not suit the settings of the run."""
        try:
            explanation = self.explanation(message)
        except UsageError as error:  # of a foreign executive's provenance: no page ends with it
            self.missing = str(error)
            return None
        return None if explanation is None else fields_of(explanation)


def _rng(context: Context, stream: int, message: Subgoals) -> np.random.Generator:
    return np.random.default_rng([context.settings.seed, stream, message.tick])


def fields_of(explanation: Explanation) -> Fields:
    """An explanation as JSON values; INVALID and unknown numbers are null."""
    energies = (explanation.chosen_j, explanation.greedy_j)
    return {
        "actions": list(explanation.actions),
        "chosen": _numbers(explanation.chosen_s),
        "greedy": _numbers(explanation.greedy_s),
        "cost": _numbers((explanation.chosen_cost, explanation.greedy_cost)),
        **({"energy": [_numbers(each) for each in energies]} if explanation.chosen_j else {}),
        **({"avoided": _avoided(explanation.avoided)} if explanation.avoided else {}),
        "parameters": [_parameter(parameter) for parameter in explanation.parameters],
    }


def _avoided(failure: AvoidedFailure) -> Fields:
    return {"action": failure.action, "straight": number(failure.straight), "by_subgoal": number(failure.by_subgoal)}


def _numbers(values: Iterable[float]) -> list[float | None]:
    return [number(value) for value in values]


def _parameter(free: FreeParameter) -> Fields:
    variable, alternatives = free.variable, free.alternatives
    return {
        "id": variable.id,
        "place": variable.label,
        "quantity": variable.quantity,
        "unit": variable.unit,
        "periodic": variable.periodic,
        "chosen": number(free.chosen),
        "greedy": number(free.greedy),
        "touched": list(free.touched),
        "values": _numbers(alternatives.values),
        "seconds": [_numbers(alternatives.durations_s[i]) for i in free.touched],  # others are constant
        "total": _numbers(alternatives.durations_s.sum(axis=0)),
        "cost": _numbers(alternatives.total_s),
    }
