"""Checks that a robot's domain has every member of the interface `Domain`, and its actions controllers to call."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.domain import Domain

ATTRIBUTES = tuple(Domain.__annotations__)
METHODS = tuple(name for name, value in vars(Domain).items() if callable(value) and not name.startswith("_"))


def faults_of_members(domain: Any) -> Iterator[str]:
    """Members of `Domain` that an object lacks, and texts in the place of tuples."""
    missing = [name for name in (*ATTRIBUTES, *METHODS) if not hasattr(domain, name)]
    if len(missing) == len(ATTRIBUTES) + len(METHODS):
        yield f"returns a {type(domain).__name__}, expected a Domain (executive/interfaces/domain.py)"
        return
    if missing:
        yield f"{type(domain).__name__} lacks {', '.join(missing)} of Domain (executive/interfaces/domain.py)"
    for name in ("sensors", "required", "belief_names"):
        if isinstance(value := getattr(domain, name, ()), str):
            yield f"{name} is '{value}', expected a tuple of names"


def faults_of_controller(action: Action) -> Iterator[str]:
    """Why nobody can call the controller of an action."""
    controller: Any = action.controller
    if isinstance(controller, type):
        yield f"controller is the class {controller.__name__}, expected an object made of it"
    elif not callable(controller):
        yield f"controller is a {type(controller).__name__}, expected a callable (executive/interfaces/action.py)"
