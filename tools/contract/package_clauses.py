"""Clauses that concern a package as a whole."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.util import find_spec
from typing import Any

from tailor.executive.interfaces.outlet import outlets_of
from tailor.executive.robot_models import load_models
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import models_folder
from tailor.schemas.parsed_files import shown
from tailor.schemas.topics import TOPICS
from tailor.tools.contract.clause import clause
from tailor.tools.contract.subject import Subject
from tailor.tools.contract.units import EXPECTED, is_unit
from tailor.tools.launch.checks.package_check import faults_of_package

SMALL = 0.1  # a command of every axis


@clause("package")
def holds_together(subject: Subject, case: str) -> Iterator[str]:
    """Spec, domain, PDDL, actions, scenarios, driver and topics match; `tailor up` demands it before a start."""
    yield from faults_of_package(subject.spec, subject.domain)


@clause("package")
def axes_contain_rest(subject: Subject, case: str) -> Iterator[str]:
    """Each axis of the command has a unit of SI, and a range with its rest in it: zero, or a kept axis' first one."""
    for axis in subject.domain.axes:
        yield from _fault_of_unit(f"axis {axis.name}", axis.unit)
        rest = 0.0 if axis.kept is None else axis.kept
        if not axis.lower <= rest <= axis.upper:
            yield f"axis {axis.name} ranges from {axis.lower:g} to {axis.upper:g}, expected {rest:g} between them"


@clause("package")
def outlets_are_driven(subject: Subject, case: str) -> Iterator[str]:
    """Of several command outlets each is driven by an action: one that none drives would only ever rest."""
    outlets = [outlet.name for outlet in outlets_of(subject.domain)]
    driven = {name for action in subject.domain.actions.values() for name in action.drives or outlets}
    yield from (f"outlet '{name}' is driven by no action" for name in outlets if name not in driven)


@clause("package")
def parameters_have_units(subject: Subject, case: str) -> Iterator[str]:
    """Each parameter of an action, and each column of its context, has a unit of SI, such as m, rad/s or 1."""
    for action in subject.domain.actions.values():
        columns = action.context.columns if action.context is not None else ()
        for what, declared in (("parameter", action.parameters), ("column", columns)):
            for each in declared:
                yield from _fault_of_unit(f"{action.name}: {what} {each.name}", each.unit)


@clause("package")
def command_becomes_a_message(subject: Subject, case: str) -> Iterator[str]:
    """`message` turns a command into a message of the type of its topic, with the given stamp."""
    for outlet in outlets_of(subject.domain):
        topic, message = outlet.topic, outlet.message(tuple(SMALL for _ in outlet.axes), 7)
        expected = TOPICS[topic].type
        if type(message) is not expected:
            yield f"message is a {type(message).__name__}, expected {expected.__name__} by the topic {topic}"
        elif getattr(message, "stamp_ns", 7) != 7:
            yield f"message has the stamp {getattr(message, 'stamp_ns', None)}, expected 7"


@clause("package")
def not_ready_before_a_percept(subject: Subject, case: str) -> Iterator[str]:
    """The initial belief is not ready: a robot that has sensed nothing does not move."""
    if subject.domain.ready(subject.domain.initial_belief()):
        yield "ready(initial_belief()) is true"


@clause("package")
def belief_values_have_units(subject: Subject, case: str) -> Iterator[str]:
    """Each name of `belief_names` ends with its unit of SI in parentheses, and no name occurs twice."""
    names = subject.domain.belief_names
    for name in names:
        unit = name.rpartition(" (")[2].removesuffix(")") if name.endswith(")") and " (" in name else ""
        yield from _fault_of_unit(f"'{name}'", unit)
    if len(set(names)) < len(names):
        yield f"a name occurs twice: {', '.join(names)}"


def _fault_of_unit(what: str, unit: str) -> Iterator[str]:
    if not unit:
        yield f"{what} has no unit"
    elif not (isinstance(unit, str) and is_unit(unit)):
        yield f"{what} has the unit {shown(unit)}, expected {EXPECTED}"


@clause("package")
def models_fit_the_actions(subject: Subject, case: str) -> Iterator[str]:
    """The models, where there are any, load, take the arguments of their actions and were trained on their ranges.

    An action that has a context needs a model of its success beside an object, too, whose arguments are free.
    """
    robot, domain = subject.domain.robot, subject.domain
    if not (models_folder(robot) / robot).is_dir():
        return
    try:
        models: Any = load_models(robot)
    except UsageError as error:
        yield str(error)
        return
    for action in domain.actions.values():
        names = [parameter.name for parameter in action.parameters]
        beside = action.context.success_model if action.context is not None else ""
        for model in filter(None, (action.duration_model, action.success_model, beside)):
            found = {**models.durations, **models.successes}.get(model)
            if found is None:
                yield f"{action.name}: there is no model {model}"
            elif model != beside and (takes := [each["name"] for each in found.card["arguments"]]) != names:
                yield f"{model}: takes {' '.join(takes)}, expected {' '.join(names)} by the action {action.name}"


@clause("package")
def features_can_be_exported(subject: Subject, case: str) -> Iterator[str]:
    """Each feature space of the package yields what it declares, and the same numbers as part of a model's graph."""
    if subject.spec.features and find_spec("onnx"):  # without the extra `learn` nothing is exported
        from tailor.models.export.space_check import faults_of_spaces

        yield from faults_of_spaces(subject.spec)
