"""Sequences of instantiated actions: values only.

A parameter of an action is a variable with an ID. Parameters with one label and one quantity share the ID, across
actions (paper 6.2.2, Figure 12). A variable whose value is not known is *free* and has a range.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from tailor.executive.interfaces.action import Action


@dataclass(frozen=True, slots=True)
class Variable:
    """What one or more action parameters stand for; bound when `value` is not None (then lower == upper == value)."""

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
        """Whether the value is still to be chosen."""
        return self.value is None

    def bound_to(self, value: float) -> Variable:
        """The same variable with its value fixed."""
        return replace(self, lower=value, upper=value, value=value)


@dataclass(frozen=True, slots=True)
class InstantiatedAction:
    """An executable action with the variables of its parameters.

    `asserted` marks a detour: it belongs to the action after it and is not counted by the horizon. `risk` is the
    probability of failure that was knowingly accepted for this action; None: the settings' limit stands.
    """

    action: Action
    step: int
    variables: tuple[int, ...]  # variable ids in the order of action.parameters
    asserted: bool = False
    risk: float | None = None


@dataclass(frozen=True, slots=True)
class ActionSequence:
    """Actions in the order of execution, and the table of their variables: `variables[i].id == i`.

    `library` holds the executable actions by name, from which assertion takes its detours. `starts` are values by
    variable id for which success was predicted: where a search may begin.
    """

    actions: tuple[InstantiatedAction, ...]
    variables: tuple[Variable, ...]
    library: Mapping[str, Action] = field(default_factory=dict)
    starts: tuple[Mapping[int, float], ...] = ()

    def free(self) -> tuple[Variable, ...]:
        """The variables that are still to be chosen, by id."""
        return tuple(variable for variable in self.variables if variable.free)

    def bind(self, values: Mapping[int, float]) -> ActionSequence:
        """The sequence with the free variables in `values` (by id) fixed; bound ones stay as they are."""
        variables = tuple(
            variable.bound_to(values[variable.id]) if variable.free and variable.id in values else variable
            for variable in self.variables
        )
        return replace(self, variables=variables)

    def starting_from(self, starts: Sequence[Mapping[int, float]]) -> ActionSequence:
        """The sequence with more known of where to start: each start joined with one that it had."""
        if not starts:
            return self
        had = self.starts or ({},)
        count = max(len(had), len(starts))
        joined = tuple({**had[i % len(had)], **starts[i % len(starts)]} for i in range(count))
        return replace(self, starts=joined)

    def within(self, horizon: int) -> tuple[InstantiatedAction, ...]:
        """The next `horizon` actions; a detour counts together with the action that it leads to."""
        return self.actions[: sum(len(unit) for unit in self.units()[:horizon])]

    def units(self) -> tuple[tuple[InstantiatedAction, ...], ...]:
        """The actions, each grouped with the detours before it."""
        units: list[tuple[InstantiatedAction, ...]] = []
        subgoals: list[InstantiatedAction] = []
        for action in self.actions:
            subgoals.append(action)
            if not action.asserted:
                units.append(tuple(subgoals))
                subgoals = []
        if subgoals:
            units.append(tuple(subgoals))
        return tuple(units)


@dataclass(frozen=True, slots=True)
class Failure:
    """Why no sequence could be made; a value, because a plan that does not fit the world is to be expected."""

    reason: str
