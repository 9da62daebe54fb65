"""Instantiation: a symbolic plan becomes a sequence of executable actions (paper 6.1, Algorithm 2).

Causal links say which predicates hold for a label of the plan; the domain turns them into values or ranges.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from executive.library import Belief, Conflict, Domain, Fact, Interval, Parameter, Scenario
from executive.planning import Plan
from executive.refinement.sequence import ActionSequence, Failure, InstantiatedAction, Variable

__all__ = ["ActionSequence", "Failure", "InstantiatedAction", "Variable", "instantiate"]

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
    table = _Table(_facts_by_label(plan), domain, belief, scenario)
    actions = []
    try:
        for step in plan.steps:
            name, *labels = step.action
            action = domain.actions[domain.executables[name]]
            variables = tuple(table.variable(parameter, labels[parameter.argument]) for parameter in action.parameters)
            actions.append(InstantiatedAction(action, step.id, variables))
    except Conflict as conflict:
        return Failure(f"{' '.join(step.action)}: {conflict}")
    return ActionSequence(tuple(actions), tuple(table.variables), domain.actions)


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


class _Table:
    """The variables made so far, one for each label and quantity."""

    def __init__(self, linked: dict[str, _Linked], domain: Domain, belief: Belief, scenario: Scenario) -> None:
        self.variables: list[Variable] = []
        self._ids: dict[tuple[str, str], int] = {}
        self._linked = linked
        self._domain = domain
        self._belief = belief
        self._scenario = scenario

    def variable(self, parameter: Parameter, label: str) -> int:
        """The id of the variable that `parameter` of `label` stands for (lines 8 to 11)."""
        key = (label, parameter.quantity)
        if key not in self._ids:
            self._ids[key] = len(self.variables)
            self.variables.append(self._made(len(self.variables), parameter, label))
        identifier = self._ids[key]
        self.variables[identifier] = _narrowed(self.variables[identifier], parameter)
        return identifier

    def _made(self, identifier: int, parameter: Parameter, label: str) -> Variable:
        linked = self._linked.get(label, _Linked())
        said = self._domain.value(
            parameter.quantity, label, tuple(linked.holds), tuple(linked.achieved), self._belief, self._scenario
        )
        default = Interval(parameter.lower, parameter.upper)
        interval = said or default
        value = interval.lower if interval.lower == interval.upper else None
        wraps = parameter.periodic and interval.upper - interval.lower >= default.upper - default.lower
        if wraps:
            interval = default
        return Variable(
            identifier, label, parameter.quantity, parameter.unit, interval.lower, interval.upper, wraps, value
        )


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
