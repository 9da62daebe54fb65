"""Checks that a robot's domain has every member of the interface `Domain`, and its actions controllers to call."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.domain import Axis, Domain
from tailor.executive.interfaces.outlet import Outlet
from tailor.schemas.parsed_files import shown

ATTRIBUTES = tuple(Domain.__annotations__)
METHODS = tuple(name for name, value in vars(Domain).items() if callable(value) and not name.startswith("_"))


def _is_text(value: Any) -> bool:
    return isinstance(value, str)


def _is_row(value: Any, kind: type) -> bool:
    return isinstance(value, tuple | list) and all(isinstance(each, kind) for each in value)


def _is_row_of_names(value: Any) -> bool:
    return _is_row(value, str)


def _is_table(value: Any, kind: type) -> bool:
    return isinstance(value, Mapping) and all(isinstance(k, str) and isinstance(v, kind) for k, v in value.items())


TEXT, NAMES = (_is_text, "text"), (_is_row_of_names, "a tuple of names")
KINDS: Mapping[str, tuple[Callable[[Any], bool], str]] = {
    "name": TEXT,
    "robot": TEXT,
    "pddl": TEXT,
    "actions": (lambda value: _is_table(value, Action), "Actions by name (executive/interfaces/action.py)"),
    "executables": (lambda value: _is_table(value, str), "names of actions by those of the PDDL"),
    "axes": (lambda value: isinstance(value, tuple) and _is_row(value, Axis), "a tuple of Axes"),
    "command_topic": TEXT,
    "sensors": NAMES,
    "required": NAMES,
    "belief_names": NAMES,
}


def faults_of_members(domain: Any) -> Iterator[str]:
    """Members of `Domain` that an object lacks, or that are of another type than declared."""
    missing = [name for name in (*ATTRIBUTES, *METHODS) if not hasattr(domain, name)]
    if len(missing) == len(ATTRIBUTES) + len(METHODS):
        yield f"returns a {type(domain).__name__}, expected a Domain (executive/interfaces/domain.py)"
        return
    if missing:
        yield f"{type(domain).__name__} lacks {', '.join(missing)} of Domain (executive/interfaces/domain.py)"
    for name in (each for each in ATTRIBUTES if hasattr(domain, each)):
        kinds, expected = KINDS[name]
        if not kinds(value := getattr(domain, name)):
            yield f"{name} is {shown(value)}, expected {expected}"
    outlets = getattr(domain, "outlets", ())
    if not _is_row(outlets, Outlet):
        yield f"outlets is {shown(outlets)}, expected a tuple of Outlets (executive/interfaces/outlet.py)"
