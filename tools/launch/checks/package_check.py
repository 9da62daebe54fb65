"""Checks that the parts of a robot's package hold together: spec, domain, PDDL, actions, scenarios, driver, topics.

A package is refused before anything starts, with all its faults in one list; each names file and field.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator

from tailor.executive import domains, planning
from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.outlet import outlets_of
from tailor.executive.refinement.assertion.asserted_subgoal import goal_indices, start_indices
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import file, spec_of
from tailor.schemas.installed.package_errors import blamed_on_package
from tailor.schemas.packages.spec import DomainSpec
from tailor.schemas.topics import TOPICS
from tailor.simnodes.driver_spec import shipped_driver_spec
from tailor.tools.launch.checks.call_check import faults_of_functions, faults_of_methods, faults_of_results
from tailor.tools.launch.checks.driver_check import faults_of_table, mismatches_of
from tailor.tools.launch.checks.field_check import faults_of_declared
from tailor.tools.launch.checks.member_check import faults_of_members
from tailor.tools.launch.checks.part_check import faults_of_parts
from tailor.tools.launch.checks.scenario_check import faults_of_scenarios


def check_package(name: str) -> Domain:
    """Load a domain whose package holds together.

    Raises:
      UsageError: There is no such domain, a part cannot be loaded, or parts do not match; all faults in one line. Or
        code of the package raises while it is asked, e.g. for its first belief.
    """
    spec, domain = spec_of(name), domains.load(name)
    with blamed_on_package(spec, f"the package of {name} cannot be checked"):
        faults = list(faults_of_package(spec, domain))
    if faults:
        raise UsageError(f"the package of {name} does not hold together: {'; '.join(faults)}")
    return domain


def faults_of_package(spec: DomainSpec, domain: Domain) -> Iterator[str]:
    """All faults of a package, each with file and field."""
    yield from faults_of_parts(spec)
    where = spec.domain
    for look in (
        faults_of_members,
        faults_of_declared,
        faults_of_methods,
        faults_of_results,
    ):  # each needs what the one before looks at
        if unlike := [f"{where}: {fault}" for fault in look(domain)]:
            yield from unlike
            return
    for field in ("name", "robot"):
        if getattr(domain, field) != getattr(spec, field):
            yield f"{where}: {field} is '{getattr(domain, field)}', expected '{getattr(spec, field)}' by the spec"
    yield from (f"{where}: {fault}" for fault in _faults_of_topics(domain))
    pddl: planning.Domain | None = None
    try:
        pddl = planning.parse_domain(domain.pddl)
    except planning.PddlError as error:
        yield f"{where}: pddl: {error}"
    if pddl is not None:
        yield from (f"{where}: {fault}" for fault in _faults_of_executables(domain, pddl))
    for action_name, action in domain.actions.items():
        yield from (f"{where}: actions['{action_name}']: {fault}" for fault in _faults_of_action(domain, action))
    yield from faults_of_scenarios(spec, pddl)
    yield from (f"{spec.driver}: {fault}" for fault in _faults_of_driver(spec, domain))


def _faults_of_topics(domain: Domain) -> Iterator[str]:
    commands = tuple(outlet.topic for outlet in outlets_of(domain))
    field_of_commands = "outlets" if getattr(domain, "outlets", ()) else "command_topic"
    for field, names in ((field_of_commands, commands), ("sensors", domain.sensors)):
        yield from (f"{field}: there is no topic '{name}'" for name in names if name not in TOPICS)
    if domain.command_topic not in commands:
        yield f"command_topic is '{domain.command_topic}', expected that of the first of outlets: {commands[0]}"
    names = tuple(outlet.name for outlet in outlets_of(domain))
    for what, each in (("name", names), ("topic", commands)):
        twice = sorted({word for word in each if each.count(word) > 1})
        yield from (f"outlets: the {what} '{word}' occurs twice" for word in twice)
    axes = tuple(axis for outlet in outlets_of(domain) for axis in outlet.axes)
    if axes != domain.axes:
        yield "axes are not those of all outlets, in their order"
    yield from (f"required: '{name}' is none of sensors" for name in domain.required if name not in domain.sensors)


def _faults_of_executables(domain: Domain, pddl: planning.Domain) -> Iterator[str]:
    schemas = {schema.name: schema for schema in pddl.actions}
    yield from (f"executables: no action of the PDDL is '{name}'" for name in domain.executables if name not in schemas)
    yield from (f"executables: '{name}' of the PDDL is missing" for name in schemas if name not in domain.executables)
    for symbolic, executable in domain.executables.items():
        if executable not in domain.actions:
            yield f"executables['{symbolic}'] is '{executable}', which is none of actions"
        elif symbolic in schemas:
            count = len(schemas[symbolic].parameters)
            for parameter in domain.actions[executable].parameters:
                if not 0 <= parameter.argument < count:
                    yield (
                        f"actions['{executable}']: parameter '{parameter.name}' has the argument {parameter.argument}, "
                        f"expected one of the {count} of '{symbolic}'"
                    )


def _faults_of_action(domain: Domain, action: Action) -> Iterator[str]:
    for kind, model in (("duration", action.duration_model), ("success", action.success_model)):
        if not model.endswith(f"/{kind}") and (model or kind == "duration"):
            yield f"{kind}_model is '{model}', expected ACTION/{kind}"
        elif model and model.rpartition("/")[0] not in domain.actions:
            yield f"{kind}_model is '{model}', expected one of an action: {', '.join(domain.actions)}"
    yield from faults_of_functions(action)
    yield from _faults_of_context(action)
    outlets = {outlet.name for outlet in outlets_of(domain)}
    yield from (f"drives '{name}', which is none of outlets" for name in action.drives if name not in outlets)
    yield from _faults_of_subgoal(domain, action)
    if not action.parameters:
        yield "parameters is empty, expected at least one: models and progress of an action are about its parameters"
    yield from _repeated(action)
    for parameter in action.parameters:
        if not (
            math.isfinite(parameter.lower) and math.isfinite(parameter.upper) and parameter.lower <= parameter.upper
        ):
            yield f"parameter '{parameter.name}' ranges from {parameter.lower:g} to {parameter.upper:g}"
        elif parameter.period == 0.0:
            yield f"parameter '{parameter.name}' is periodic, but ranges from {parameter.lower:g} to the same"


def _repeated(action: Action) -> Iterator[str]:
    """Names that occur twice, and parameters that would always have one value: a robot drives to (x, x)."""
    names = [parameter.name for parameter in action.parameters]
    yield from (f"parameter '{name}' occurs twice" for name in sorted({n for n in names if names.count(n) > 1}))
    first: dict[tuple[int, str], str] = {}
    for each in action.parameters:
        other = first.setdefault((each.argument, each.quantity), each.name)
        if other != each.name:
            what = f"the quantity '{each.quantity}' of argument {each.argument}"
            yield f"parameters '{other}' and '{each.name}' are both {what}, expected one parameter for it"


def _faults_of_subgoal(domain: Domain, action: Action) -> Iterator[str]:
    """Faults of the action that leads to a subgoal: it starts where this one would, so it needs no more to be known."""
    if not action.subgoal_action:
        return
    leading = domain.actions.get(action.subgoal_action)
    if leading is None:
        yield f"subgoal_action is '{action.subgoal_action}', which is none of actions"
    elif action.parameters and leading.parameters:
        known = {action.parameters[j].quantity for j in start_indices(action)}
        goals = goal_indices(leading)
        for parameter in (each for j, each in enumerate(leading.parameters) if j not in goals):
            if parameter.quantity not in known:
                yield (
                    f"subgoal_action '{leading.name}' begins with the quantity '{parameter.quantity}', "
                    f"expected one of this action's first label: {', '.join(sorted(known))}"
                )


def _faults_of_context(action: Action) -> Iterator[str]:
    context = action.context
    if context is None:
        return
    if not context.success_model.endswith("/clearance"):
        yield f"context: success_model is '{context.success_model}', expected ACTION/clearance"
    if not context.failure:
        yield "context: failure is empty, expected the failure that the task sampler returns for an object"
    taken = [parameter.name for parameter in action.parameters]
    for column in context.columns:
        if column.name in taken:
            yield f"context: column '{column.name}' occurs twice, among the parameters or the columns"
        if not (math.isfinite(column.lower) and math.isfinite(column.upper) and column.lower < column.upper):
            yield f"context: column '{column.name}' ranges from {column.lower:g} to {column.upper:g}"
        taken.append(column.name)


def _faults_of_driver(spec: DomainSpec, domain: Domain) -> Iterator[str]:
    try:
        declared = shipped_driver_spec(spec.robot)
    except UsageError as error:
        yield str(error)
        return
    yield from mismatches_of(domain, declared)
    table = tomllib.loads(file(spec, "driver").read_text(encoding="utf-8"))
    yield from faults_of_table(table, domain)
