"""PDDL text of a problem of unified-planning, by its own writer; what that writer cannot write is rewritten before."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from unified_planning.exceptions import UPException
from unified_planning.io import PDDLWriter

from tailor.executive.planning import Unsupported
from tailor.executive.planning.pddl.action_reader import NUMERIC_EFFECTS
from tailor.executive.planning.pddl.formula_reader import CONNECTIVES
from tailor.tools.up_engine.quantifiers import exact_quantifiers


@dataclass(frozen=True, slots=True)
class Written:
    """The texts of domain and problem, and the writer that keeps the names of both kinds.

    `is_possible` is false if some goal never holds: PDDL has no word for that, so the text lacks such a goal.
    """

    writer: PDDLWriter
    domain: str
    problem: str
    is_possible: bool


def written(original: Any) -> Written:
    """The problem as PDDL.

    Raises:
      Unsupported: PDDL, or the writer, has no words for it.
    """
    with exact_quantifiers(original):
        return _written(original)


def _written(original: Any) -> Written:
    goals = [goal.simplify() for goal in original.goals]
    try:
        _check_costs(original)
        writer = _writer(_writable(original, goals))
        writer.get_domain()  # this one lacks the constants that only costs name: they are found after it is written
        texts = writer.get_domain(), writer.get_problem()
    except (UPException, NotImplementedError) as error:
        raise Unsupported(f"not expressible in PDDL: {error}") from None
    return Written(writer, *texts, is_possible=not any(goal.is_false() for goal in goals))


def _writer(problem: Any) -> PDDLWriter:
    """A writer that uses no name that means something else to our parser."""
    writer = PDDLWriter(problem)
    writer.pddl_keywords = writer.pddl_keywords | CONNECTIVES | NUMERIC_EFFECTS | {"total-cost"}
    if any(kind.name.lower() == "object" for kind in problem.user_types):
        writer.problem_kind.set_typing("HIERARCHICAL_TYPING")  # else it takes this type for PDDL's, which all have
    return writer


def _check_costs(problem: Any) -> None:
    """Raises if an action has no cost, which unified-planning calls invalid: its writer would leave a broken state."""
    for metric in problem.quality_metrics:
        if metric.is_minimize_action_costs():
            for action in problem.actions:
                if metric.get_action_cost(action) is None:
                    raise Unsupported(f"the metric has no cost of the action {action.name}, and no default")


def _writable(original: Any, goals: list[Any]) -> Any:
    """The problem without goals that are always true or never, and without "for all" in timed effects."""
    constant = any(goal.is_bool_constant() for goal in goals)
    effects = [(timing, effect) for timing, some in original.timed_effects.items() for effect in some]
    if any(not effect.condition.simplify().is_true() for _, effect in effects):
        raise Unsupported("a timed effect under a condition is not supported")
    if not constant and not any(effect.is_forall() for _, effect in effects):
        return original
    writable = original.clone()
    writable.clear_goals()
    for goal in goals:
        if not goal.is_bool_constant():
            writable.add_goal(goal)
    writable.clear_timed_effects()
    for timing, effect in effects:
        for each in effect.expand_effect(original):
            writable.add_timed_effect(timing, each.fluent, each.value)
    return writable
