"""Sequences of instantiated actions: values only.

A parameter of an action is a variable with an id. Parameters with the same label and quantity share the id, across
actions (paper 6.2.2, Figure 12). A variable without a value is *free* and has a range.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.action_context import ContextRows


@dataclass(frozen=True, slots=True)
class Variable:
    """Variable of one or more action parameters; bound if `value` is not None (then lower == upper == value)."""

    id: int
    label: str
    quantity: str
    unit: str
    lower: float
    upper: float
    periodic: bool
    value: float | None

    @property
    def free(self) -> bool:
        """Whether the variable has no value yet."""
        return self.value is None

    def bound_to(self, value: float) -> Variable:
        """The variable with its value fixed."""
        return replace(self, lower=value, upper=value, value=value)


@dataclass(frozen=True, slots=True)
class InstantiatedAction:
    """Executable action with the variables of its parameters.

    `asserted` marks an action that leads to an asserted subgoal: it belongs to the action after it and does not count
    in the horizon. `risk` is the accepted probability of failure of this action; None: the settings' limit applies.
    `context` are the believed objects near which the action may fail.
    """

    action: Action
    step: int
    variables: tuple[int, ...]  # variable ids in the order of action.parameters
    asserted: bool = False
    risk: float | None = None
    context: ContextRows = ()

    @property
    def may_fail(self) -> bool:
        """Whether a success model has to be queried for this action."""
        return bool(self.action.success_model or self.context)


@dataclass(frozen=True, slots=True)
class ActionSequence:
    """Actions in the order of execution, and their variable table: `variables[i].id == i`.

    `library` holds the executable actions by name; assertion takes the subgoal actions from it. `starts` are values by
    variable id for which success was predicted: initial candidates for a search. `contexts` are the believed objects by
    executable action, for asserted subgoals.
    """

    actions: tuple[InstantiatedAction, ...]
    variables: tuple[Variable, ...]
    library: Mapping[str, Action] = field(default_factory=dict)
    starts: tuple[Mapping[int, float], ...] = ()
    contexts: Mapping[str, ContextRows] = field(default_factory=dict)

    def free(self) -> tuple[Variable, ...]:
        """Free variables, by id."""
        return tuple(variable for variable in self.variables if variable.free)

    def values_of(self, known: Mapping[tuple[str, str], float]) -> dict[int, float]:
        """Known values of the free variables, by id, from values by label and quantity; none that are out of range."""
        found = {v.id: known[v.label, v.quantity] for v in self.free() if (v.label, v.quantity) in known}
        return {i: value for i, value in found.items() if self.variables[i].lower <= value <= self.variables[i].upper}

    def bind(self, values: Mapping[int, float]) -> ActionSequence:
        """The sequence with the free variables in `values` (by id) fixed; bound ones are unchanged."""
        variables = tuple(
            variable.bound_to(values[variable.id]) if variable.free and variable.id in values else variable
            for variable in self.variables
        )
        return replace(self, variables=variables)

    def starting_from(self, starts: Sequence[Mapping[int, float]]) -> ActionSequence:
        """The sequence with further starts: each is merged with one of the sequence's own; equal ones count once."""
        if not starts:
            return self
        own = self.starts or ({},)
        count = max(len(own), len(starts))
        merged: list[Mapping[int, float]] = []
        for i in range(count):
            start = {**own[i % len(own)], **starts[i % len(starts)]}
            if start not in merged:
                merged.append(start)
        return replace(self, starts=tuple(merged))

    def within(self, horizon: int) -> tuple[InstantiatedAction, ...]:
        """The next `horizon` actions; an asserted subgoal counts together with the action after it."""
        return self.actions[: sum(len(unit) for unit in self.units()[:horizon])]

    def units(self) -> tuple[tuple[InstantiatedAction, ...], ...]:
        """Actions, each grouped with the asserted subgoals before it."""
        units: list[tuple[InstantiatedAction, ...]] = []
        unit: list[InstantiatedAction] = []
        for action in self.actions:
            unit.append(action)
            if not action.asserted:
                units.append(tuple(unit))
                unit = []
        if unit:
            units.append(tuple(unit))
        return tuple(units)


@dataclass(frozen=True, slots=True)
class Failure:
    """Reason why there is no sequence; a value, because a plan that does not fit the world is expected."""

    reason: str
