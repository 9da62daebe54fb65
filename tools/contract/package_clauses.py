"""Clauses that concern a package as a whole."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tailor.executive.interfaces.outlet import outlets_of
from tailor.executive.robot_models import load_models
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import models_folder
from tailor.schemas.topics import TOPICS
from tailor.tools.contract.clause import clause
from tailor.tools.contract.subject import Subject
from tailor.tools.launch.checks.package_check import faults_of_package

SMALL = 0.1  # a command of every axis


@clause("package")
def holds_together(subject: Subject, case: str) -> Iterator[str]:
    """Spec, domain, PDDL, actions, scenarios, driver and topics match; `tailor up` demands it before a start."""
    yield from faults_of_package(subject.spec, subject.domain)


@clause("package")
def axes_contain_rest(subject: Subject, case: str) -> Iterator[str]:
    """Each axis of the command has a unit and a range with its rest in it: zero, or what a kept axis starts with."""
    for axis in subject.domain.axes:
        if not axis.unit:
            yield f"axis {axis.name} has no unit"
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
    """Each parameter of an action has a unit."""
    for action in subject.domain.actions.values():
        yield from (f"{action.name}: parameter {p.name} has no unit" for p in action.parameters if not p.unit)


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
    """Each name of `belief_names` ends with its unit in parentheses, and no name occurs twice."""
    names = subject.domain.belief_names
    yield from (f"'{name}' has no unit" for name in names if not (name.endswith(")") and " (" in name))
    if len(set(names)) < len(names):
        yield f"a name occurs twice: {', '.join(names)}"


@clause("package")
def models_fit_the_actions(subject: Subject, case: str) -> Iterator[str]:
    """The models, where there are any, load, take the arguments of their actions and were trained on their ranges."""
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
        for model in filter(None, (action.duration_model, action.success_model)):
            found = {**models.durations, **models.successes}.get(model)
            if found is None:
                yield f"{action.name}: there is no model {model}"
            elif (takes := [each["name"] for each in found.card["arguments"]]) != names:
                yield f"{model}: takes {' '.join(takes)}, expected {' '.join(names)} by the action {action.name}"
