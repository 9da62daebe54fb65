"""Checks that the fields of what a domain declares have the types that they are declared with.

A text in the place of a number would show up in a tick, in code of ours.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields
from numbers import Integral, Real
from typing import Any

from tailor.executive.interfaces.action import Action, Parameter
from tailor.executive.interfaces.action_context import ActionContext, ContextColumn
from tailor.executive.interfaces.domain import Domain
from tailor.schemas.parsed_files import shown

# by the annotation, of one value or of each in a tuple
KINDS: Mapping[str, tuple[type, str]] = {
    "str": (str, "text"),
    "int": (Integral, "a whole number"),
    "float": (Real, "a number"),
    "bool": (bool, "True or False"),
    "Parameter": (Parameter, "Parameters"),
    "ContextColumn": (ContextColumn, "ContextColumns"),
    "ActionContext": (ActionContext, "an ActionContext"),
}


def faults_of_declared(domain: Domain) -> Iterator[str]:
    """Fields of a domain's axes, outlets and actions, and of the parameters and contexts of these."""
    for axis in domain.axes:
        yield from _faults(f"axis {shown(axis.name)}", axis)
    for outlet in getattr(domain, "outlets", ()):
        yield from _faults(f"outlet {shown(outlet.name)}", outlet)
    for name, action in domain.actions.items():
        where = f"actions['{name}']"
        found = [*_faults(where, action)]
        yield from found or _faults_within(where, action)


def _faults_within(where: str, action: Action) -> Iterator[str]:
    for parameter in action.parameters:
        yield from _faults(f"{where}: parameter {shown(parameter.name)}", parameter)
    if action.context is not None:
        found = [*_faults(f"{where}: context", action.context)]
        yield from found
        for column in () if found else action.context.columns:
            yield from _faults(f"{where}: column {shown(column.name)}", column)


def _faults(where: str, value: Any) -> Iterator[str]:
    for field in fields(value):
        written, found = str(field.type), getattr(value, field.name)
        if written.endswith(" | None") and found is None:
            continue
        written = written.removesuffix(" | None")
        single = written.removeprefix("tuple[").removesuffix(", ...]")
        kind, expected = KINDS.get(single, (object, "values"))
        if single == written:
            well = isinstance(found, kind)
        else:
            well = isinstance(found, tuple | list) and all(isinstance(each, kind) for each in found)
            expected = f"a tuple of {expected}"
        if not well:
            yield f"{where}: {field.name} is {shown(found)}, expected {expected}"
