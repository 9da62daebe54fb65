"""Reads a PDDL problem: objects, initial state, goal, metric."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Literal as OneOf

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.domain_reader import check_requirements, define_name
from tailor.executive.planning.pddl.formula_reader import Scope, expect, read_atom, read_formula, read_terms
from tailor.executive.planning.pddl.language import Domain, Formula, Literal, Typed
from tailor.executive.planning.pddl.numeric_reader import number_of
from tailor.executive.planning.pddl.problem import Problem, TimedLiteral
from tailor.executive.planning.pddl.syntax.s_expressions import (
    Form,
    Place,
    Word,
    form_of,
    parts_in_order,
    read_form,
    text_of,
    word_of,
)
from tailor.executive.planning.pddl.times import NANOSECOND_S, nanoseconds
from tailor.executive.planning.pddl.typed_lists import MAX_OBJECTS, read_typed

MAX_TIMED = 200  # each is a node of every temporal network
_METRICS: dict[str, OneOf["makespan", "cost"]] = {
    "total-time": "makespan",
    "makespan": "makespan",
    "total-cost": "cost",
}


@dataclass(slots=True)
class _Draft:
    """The parts of a problem read so far."""

    objects: tuple[Typed, ...] = ()
    initial: dict[Fact, None] = field(default_factory=dict)
    denied: set[Fact] = field(default_factory=set)
    values: dict[Fact, float] = field(default_factory=dict)
    timed: list[TimedLiteral] = field(default_factory=list)
    goal: Formula | None = None
    goal_text: str = ""
    metric: OneOf["", "makespan", "cost"] = ""


def parse_problem(text: str, domain: Domain, source: str = "problem") -> Problem:
    """Reads a problem of `domain`.

    Args:
      text: PDDL 2.1; lower and upper case are equal.
      domain: The domain that the problem names.
      source: Name of the text in errors, e.g. its file name.

    Returns:
      The problem, names in lower case.

    Raises:
      PddlError: Malformed text, as "source:line:column: reason"; `Unsupported` for PDDL outside the language.
    """
    form = read_form(text, source)
    name = define_name(form, "problem")
    draft = _Draft()
    for part in parts_in_order(form, "a part such as (:goal ...)", (":objects",), frozenset({":requirements"})):
        _read_part(part, draft, domain)
    if draft.goal is None:
        raise form.place.error("the problem has no (:goal ...)")
    return Problem(
        name, domain, draft.objects, tuple(draft.initial), draft.goal, draft.goal_text, draft.values,
        tuple(draft.timed), draft.metric,
    )  # fmt: skip


def _read_part(form: Form, draft: _Draft, domain: Domain) -> None:
    rest = form.items[1:]
    match form.head:
        case ":domain":
            _check_domain(form, domain)
        case ":requirements":
            check_requirements(rest)
        case ":objects":
            draft.objects = read_typed(rest, domain.types)
            if len(draft.objects) + len(domain.constants) > MAX_OBJECTS:
                raise form.place.error(f"more than {MAX_OBJECTS} objects and constants")
            _reject_constants(form, draft.objects, domain)
        case ":init":
            scope = Scope.of(domain, draft.objects)
            for item in rest:
                _read_initial(form_of(item, "a fact"), draft, scope)
        case ":goal":
            expect(form, 1)
            draft.goal = read_formula(rest[0], Scope.of(domain, draft.objects))
            draft.goal_text = text_of(rest[0])
        case ":metric":
            _read_metric(form, draft)
        case ":length":
            pass  # a hint from the first planning competition; ignored
        case ":constraints":
            raise form.place.unsupported("a trajectory constraint")
        case head:
            raise form.place.error(f"unknown part '{head}' of a problem")


def _check_domain(form: Form, domain: Domain) -> None:
    expect(form, 1)
    name = word_of(form.items[1], "the domain's name")
    if name != domain.name:
        raise form.items[1].place.error(f"the problem belongs to domain '{name}', not '{domain.name}'")


def _reject_constants(form: Form, objects: tuple[Typed, ...], domain: Domain) -> None:
    constants = {constant.name for constant in domain.constants}
    declared = {item.name for item in objects}
    for node in form.items[1:]:
        if isinstance(node, Word) and node.text in constants & declared:
            raise node.place.error(f"'{node.text}' is already a constant of the domain")


# --- initial state -------------------------------------------------------------------------------
def _read_initial(form: Form, draft: _Draft, scope: Scope) -> None:
    if form.head == "=":
        _read_value(form, draft, scope)
    elif _is_timed(form):
        time_s = number_of(form.items[1])
        if time_s < 0:
            raise form.items[1].place.error("expected a time of at least 0")
        if len(draft.timed) == MAX_TIMED:
            raise form.place.error(f"more than {MAX_TIMED} timed literals")
        literal = _literal(form_of(form.items[2], "a literal"), scope)
        opposite, time_ns = replace(literal, positive=not literal.positive), nanoseconds(time_s)
        if any(other.literal == opposite and nanoseconds(other.time_s) == time_ns for other in draft.timed):
            raise form.place.error(f"{literal} and its opposite at the same time")
        if time_s < NANOSECOND_S:  # a literal at time 0 is one of the initial state
            _enter(literal, draft, form.place)
        else:
            draft.timed.append(TimedLiteral(time_s, literal))
    else:
        _enter(_literal(form, scope), draft, form.place)


def _enter(literal: Literal, draft: _Draft, place: Place) -> None:
    """Enters a literal of the initial state, where all else is false."""
    if literal.fact in (draft.denied if literal.positive else draft.initial):
        raise place.error(f"{literal} and its opposite in the initial state")
    if literal.positive:
        draft.initial.setdefault(literal.fact)
    else:
        draft.denied.add(literal.fact)


def _is_timed(form: Form) -> bool:
    """Whether this is (at 5 (door-open)) and not an atom of a predicate called `at`."""
    return form.head == "at" and len(form.items) == 3 and isinstance(form.items[2], Form)


def _literal(form: Form, scope: Scope) -> Literal:
    positive = form.head != "not"
    if not positive:
        expect(form, 1)
        form = form_of(form.items[1], "an atom")
    atom = read_atom(form, scope)
    return Literal((atom.predicate, *atom.terms), positive)


def _read_value(form: Form, draft: _Draft, scope: Scope) -> None:
    expect(form, 2)
    function = form_of(form.items[1], expected := "a function such as (distance a b)")
    if not function.head:
        raise function.place.error(f"expected {expected}, found {function.outline}")
    parameters = scope.domain.functions.get(function.head)
    if parameters is None:
        raise function.place.error(f"unknown function '{function.head}'")
    terms = read_terms(function, parameters, scope)
    fact, value = (function.head, *terms), number_of(form.items[2])
    if draft.values.setdefault(fact, value) != value:
        raise form.place.error(f"({' '.join(fact)}) has another value already: {draft.values[fact]:g}")


# --- metric --------------------------------------------------------------------------------------
def _read_metric(form: Form, draft: _Draft) -> None:
    expect(form, 2)
    direction = word_of(form.items[1], "minimize")
    quantity = text_of(form.items[2])
    name = quantity[1:-1] if quantity[0] == "(" else quantity
    if direction != "minimize" or name not in _METRICS:
        raise form.place.unsupported(f"the metric {direction} {quantity}")
    draft.metric = _METRICS[name]
