"""Instantiation: a symbolic plan becomes a sequence of executable actions (paper 6.1, Algorithm 2).

Causal links say which predicates hold for a label of the plan; the domain turns them into values or ranges.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from tailor.executive.interfaces.action import Parameter
from tailor.executive.interfaces.domain import Conflict, Domain, LabelQuery, Scenario
from tailor.executive.interfaces.values import Belief, Fact, Interval
from tailor.executive.planning import Plan
from tailor.executive.refinement.objective.sequence import (
    ActionSequence,
    Failure,
    InstantiatedAction,
    Variable,
)

__all__ = ["ActionSequence", "Failure", "InstantiatedAction", "Pattern", "Variable", "instantiate"]

INITIAL = 0  # producer id of what holds in the initial state


def instantiate(plan: Plan, domain: Domain, belief: Belief, scenario: Scenario) -> ActionSequence | Failure:
    """Map a plan to executable actions with bound and free parameters (Algorithm 2).

    Args:
      plan: Steps by start time, with causal links, those from the initial state included.
      domain: Action library and meaning of the predicates.
      belief: The domain's belief state of now.
      scenario: What the labels mean.

    Returns:
      The actions in plan order, or why the predicates over a label exclude each other.
    """
    return Pattern(plan, domain, scenario).sequence(belief)


class Pattern:
    """Instantiation of one plan as far as it does not depend on the belief: which variable each parameter stands for.

    Args:
      plan: Steps by start time, with causal links, those from the initial state included.
      domain: Action library and meaning of the predicates.
      scenario: What the labels mean.
    """

    def __init__(self, plan: Plan, domain: Domain, scenario: Scenario) -> None:
        self._domain, self._scenario = domain, scenario
        self._linked = _facts_by_label(plan)
        self._slots: list[_Slot] = []  # one for each label and quantity (lines 8 to 11), by id
        self._uses: list[tuple[tuple[str, ...], int, Parameter]] = []  # action of the plan, slot, parameter; in order
        ids: dict[tuple[str, str], int] = {}
        self.actions = tuple(self._action(step.action, step.id, ids) for step in plan.steps)

    def sequence(self, belief: Belief) -> ActionSequence | Failure:
        """The plan's actions with what the belief says of their variables, or why that excludes itself."""
        variables: list[Variable] = []
        for action, identifier, parameter in self._uses:
            try:
                if identifier == len(variables):
                    variables.append(self._made(identifier, belief))
                variables[identifier] = _narrowed(variables[identifier], parameter)
            except Conflict as conflict:
                return Failure(f"{' '.join(action)}: {conflict}")
        return ActionSequence(self.actions, tuple(variables), self._domain.actions)

    def value(self, identifier: int, belief: Belief) -> float | None:
        """What `sequence` gives one variable; None if it is free. Raises Conflict if there is no sequence."""
        said = self._said(self._slots[identifier], belief)
        if said is not None and said.lower == said.upper:
            return said.lower
        variable = self._made(identifier, belief)
        for _, used, parameter in self._uses:
            if used == identifier:
                variable = _narrowed(variable, parameter)
        return variable.value

    def _action(self, symbolic: tuple[str, ...], step: int, ids: dict[tuple[str, str], int]) -> InstantiatedAction:
        name, *labels = symbolic
        action = self._domain.actions[self._domain.executables[name]]
        variables = []
        for parameter in action.parameters:
            key = (labels[parameter.argument], parameter.quantity)
            if key not in ids:
                ids[key] = len(ids)
                self._slots.append(_Slot(key[0], parameter, *self._predicates(key[0])))
            variables.append(ids[key])
            self._uses.append((symbolic, ids[key], parameter))
        return InstantiatedAction(action, step, tuple(variables))

    def _predicates(self, label: str) -> tuple[tuple[Fact, ...], tuple[Fact, ...]]:
        linked = self._linked.get(label, _Linked())
        return tuple(linked.holds), tuple(linked.achieved)

    def _said(self, slot: _Slot, belief: Belief) -> Interval | None:
        quantity = slot.parameter.quantity
        query = LabelQuery(quantity, slot.label, slot.holds, slot.achieved, belief, self._scenario)
        return self._domain.value(query)

    def _made(self, identifier: int, belief: Belief) -> Variable:
        slot = self._slots[identifier]
        parameter = slot.parameter
        default = Interval(parameter.lower, parameter.upper)
        interval = self._said(slot, belief) or default
        value = interval.lower if interval.lower == interval.upper else None
        wraps = parameter.periodic and interval.upper - interval.lower >= default.upper - default.lower
        if wraps:
            interval = default
        return Variable(
            identifier, slot.label, parameter.quantity, parameter.unit, interval.lower, interval.upper, wraps, value
        )


@dataclass(frozen=True, slots=True)
class _Slot:
    """A variable before its value is known: the parameter that it was made for, and the predicates over its label."""

    label: str
    parameter: Parameter
    holds: tuple[Fact, ...]
    achieved: tuple[Fact, ...]


@dataclass(frozen=True, slots=True)
class _Linked:
    """The predicates over one label: what holds already, and what earlier actions achieve."""

    holds: list[Fact] = field(default_factory=list)
    achieved: list[Fact] = field(default_factory=list)


def _facts_by_label(plan: Plan) -> dict[str, _Linked]:
    """`parseCausalLinks` of Algorithm 2: pos2 -> [0ball, 2atball]. What must *not* hold says nothing of values."""
    linked: dict[str, _Linked] = {}
    for link in plan.links:
        if not link.literal.positive:
            continue
        fact = link.literal.fact
        for label in dict.fromkeys(fact[1:]):
            entry = linked.setdefault(label, _Linked())
            facts = entry.holds if link.producer == INITIAL else entry.achieved
            if fact not in facts:
                facts.append(fact)
    return linked


def _narrowed(variable: Variable, parameter: Parameter) -> Variable:
    """A free variable keeps to the default range of every parameter that it stands for.

    A known value stays as the belief says, even out of range: the robot is where it is. An angle's range may lie across
    the ends of the default range, so that part of a turn is left as the predicates gave it.
    """
    if not variable.free or parameter.periodic:
        return variable
    lower, upper = max(variable.lower, parameter.lower), min(variable.upper, parameter.upper)
    if lower > upper:
        raise Conflict(
            f"{variable.quantity} of {variable.label} is asked to be in [{variable.lower:g}, {variable.upper:g}] "
            f"but {parameter.name} has the range [{parameter.lower:g}, {parameter.upper:g}]"
        )
    narrowed = replace(variable, lower=lower, upper=upper)
    return narrowed.bound_to(lower) if lower == upper else narrowed
