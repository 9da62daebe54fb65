"""Instantiation: a symbolic plan becomes a sequence of executable actions (paper 6.1, Algorithm 2).

Causal links give the predicates that hold for a label of the plan; the domain turns them into values or ranges.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from tailor.executive.interfaces.action import Action, Parameter
from tailor.executive.interfaces.action_context import ContextRows
from tailor.executive.interfaces.domain import Conflict, Domain, LabelQuery, Scenario
from tailor.executive.interfaces.domain_results import value_of
from tailor.executive.interfaces.values import Belief, Fact, Interval
from tailor.executive.planning import Plan
from tailor.executive.refinement.label_facts import LabelFacts, facts_by_label
from tailor.executive.refinement.objective.sequence import ActionSequence, Failure, InstantiatedAction, Variable

MAX_ACTIONS = 50  # more than any horizon in use: keeps a tick and its messages bounded


def instantiate(plan: Plan, domain: Domain, belief: Belief, scenario: Scenario) -> ActionSequence | Failure:
    """Map a plan to executable actions with bound and free parameters (Algorithm 2).

    Args:
      plan: Steps by start time, with causal links, those from the initial state included.
      domain: Action library and ranges of the predicates.
      belief: The domain's current belief state.
      scenario: Places and settings of the task.

    Returns:
      The next actions, in plan order, or the reason why the predicates over a label exclude each other.
    """
    return Pattern(plan, domain, scenario).sequence(belief)


class Pattern:
    """Part of a plan's instantiation that does not depend on the belief: the variable of each parameter.

    Of a long plan only the next actions are instantiated, with the predicates of all its links: after every action the
    rest of the plan is instantiated anew.

    Args:
      plan: Steps by start time, with causal links, those from the initial state included.
      domain: Action library and ranges of the predicates.
      scenario: Places and settings of the task.
      length: Maximum number of actions.
    """

    def __init__(self, plan: Plan, domain: Domain, scenario: Scenario, length: int = MAX_ACTIONS) -> None:
        self._domain, self._scenario = domain, scenario
        self._label_facts = facts_by_label(plan)
        self._slots: list[_Slot] = []  # one for each label and quantity (lines 8 to 11), by variable id
        self._uses: list[_Use] = []  # in plan order
        ids: dict[tuple[str, str], int] = {}
        self.actions = tuple(self._action(step.action, step.id, ids) for step in plan.steps[:length])

    def sequence(self, belief: Belief) -> ActionSequence | Failure:
        """The plan's actions with variables from the belief, or the reason why the predicates exclude each other."""
        variables: list[Variable] = []
        for use in self._uses:
            try:
                if use.variable == len(variables):
                    variables.append(self._variable(use.variable, belief))
                variables[use.variable] = _narrow(variables[use.variable], use.parameter)
            except Conflict as conflict:
                return Failure(f"{' '.join(use.action)}: {conflict}")
        contexts = believed_contexts(self._domain.actions, belief)
        actions = tuple(
            replace(instance, context=contexts[instance.action.name]) if instance.action.context else instance
            for instance in self.actions
        )
        return ActionSequence(actions, tuple(variables), self._domain.actions, contexts=contexts)

    def planned(self, action: InstantiatedAction) -> Iterator[tuple[Parameter, int, int]]:
        """Each parameter of an action of a sequence, with its variable there and in this pattern.

        Empty for an action that is not in the plan: one that leads to an asserted subgoal.
        """
        at = action.step, action.action.name
        same = next((each for each in self.actions if (each.step, each.action.name) == at), None)
        if same is not None and not action.asserted:
            yield from zip(action.action.parameters, action.variables, same.variables, strict=True)

    def value(self, identifier: int, belief: Belief) -> float | None:
        """Value of one variable in `sequence(belief)`; None if it is free.

        Raises:
          Conflict: There is no sequence for this belief.
        """
        interval = self._interval(self._slots[identifier], belief)
        if interval is not None and interval.lower == interval.upper:
            return interval.lower
        return self.variable(identifier, belief).value

    def variable(self, identifier: int, belief: Belief) -> Variable:
        """One variable of `sequence(belief)`.

        Raises:
          Conflict: There is no sequence for this belief.
        """
        variable = self._variable(identifier, belief)
        for use in self._uses:
            if use.variable == identifier:
                variable = _narrow(variable, use.parameter)
        return variable

    def _action(self, symbolic: tuple[str, ...], step: int, ids: dict[tuple[str, str], int]) -> InstantiatedAction:
        name, *labels = symbolic
        action = self._domain.actions[self._domain.executables[name]]
        variables = []
        for parameter in action.parameters:
            key = (labels[parameter.argument], parameter.quantity)
            if key not in ids:
                ids[key] = len(ids)
                facts = self._label_facts.get(key[0], LabelFacts())
                self._slots.append(_Slot(key[0], parameter, tuple(facts.holds), tuple(facts.achieved)))
            variables.append(ids[key])
            self._uses.append(_Use(symbolic, ids[key], parameter))
        return InstantiatedAction(action, step, tuple(variables))

    def _interval(self, slot: _Slot, belief: Belief) -> Interval | None:
        quantity = slot.parameter.quantity
        query = LabelQuery(quantity, slot.label, slot.holds, slot.achieved, belief, self._scenario)
        return value_of(self._domain, query)

    def _variable(self, identifier: int, belief: Belief) -> Variable:
        slot = self._slots[identifier]
        parameter = slot.parameter
        default = Interval(parameter.lower, parameter.upper)
        interval = self._interval(slot, belief) or default
        value = interval.lower if interval.lower == interval.upper else None
        periodic = parameter.periodic and interval.upper - interval.lower >= default.upper - default.lower
        if periodic:
            interval = default
        return Variable(
            identifier, slot.label, parameter.quantity, parameter.unit, interval.lower, interval.upper, periodic, value
        )


def believed_contexts(library: Mapping[str, Action], belief: Belief) -> dict[str, ContextRows]:
    """The believed objects of each executable action that has a context, by its name."""
    contexts = {action.name: action.context for action in library.values() if action.context is not None}
    return {name: context.believed(belief) for name, context in contexts.items()}


@dataclass(frozen=True, slots=True)
class _Slot:
    """Variable without a range: the first parameter that it stands for, and the predicates over its label."""

    label: str
    parameter: Parameter
    holds: tuple[Fact, ...]
    achieved: tuple[Fact, ...]


@dataclass(frozen=True, slots=True)
class _Use:
    """Occurrence of a variable: symbolic action, variable id and parameter of the executable action."""

    action: tuple[str, ...]
    variable: int
    parameter: Parameter


def _narrow(variable: Variable, parameter: Parameter) -> Variable:
    """The variable, if free, restricted to the default range of a parameter that it stands for.

    A bound value is not changed, even out of range: the belief determines it. The range of an angle may cross the ends
    of the default range, so a partial turn is not restricted either.
    """
    if not variable.free or parameter.periodic:
        return variable
    lower, upper = max(variable.lower, parameter.lower), min(variable.upper, parameter.upper)
    if lower > upper:
        raise Conflict(
            f"{variable.quantity} of {variable.label} is restricted to [{variable.lower:g}, {variable.upper:g}] "
            f"but {parameter.name} has the range [{parameter.lower:g}, {parameter.upper:g}]"
        )
    if (lower, upper) == (variable.lower, variable.upper) and lower < upper:
        return variable
    narrowed = replace(variable, lower=lower, upper=upper)
    return narrowed.bound_to(lower) if lower == upper else narrowed
