"""Checks that what a robot's package declares can be called as Tailor calls it, and returns what is expected.

A call with other arguments than a function takes is an error in code of ours, which names no package.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from tailor.executive.interfaces.action import Action, Controller, SubgoalRisk
from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.domain_results import first_belief, is_ready, kept_at, relocations, telemetry, updated
from tailor.schemas.errors import UsageError
from tailor.schemas.installed.package_errors import raised_text
from tailor.schemas.parsed_files import shown
from tailor.tools.launch.checks.member_check import METHODS

OPTIONAL = {"relocations": ("belief",), "kept": ("belief",), "measurement_fault": ("belief", "message")}
ROWS = 3  # of parameters, with which `arguments` is tried


def faults_of_methods(domain: Domain) -> Iterator[str]:
    """Methods of a domain that cannot be called as declared."""
    declared = {name: _names(getattr(Domain, name)) for name in METHODS}
    present = {name: names for name, names in OPTIONAL.items() if hasattr(domain, name)}
    for name, names in {**declared, **present}.items():
        yield from fault_of_call(name, getattr(domain, name), names)
    for outlet in getattr(domain, "outlets", ()):
        yield from fault_of_call(f"outlets: message of '{outlet.name}'", outlet.message, ("command", "stamp_ns"))


def faults_of_functions(action: Action) -> Iterator[str]:
    """Functions of an action that cannot be called as declared, or make no arguments for its models."""
    functions: list[tuple[str, Any, tuple[str, ...]]] = [
        ("controller", action.controller, _names(Controller.__call__)),
        ("arguments", action.arguments, ("values",)),
        ("subgoal_risk", action.subgoal_risk, _names(SubgoalRisk.__call__)),
        ("spans", action.spans, ("lower", "upper")),
    ]
    if action.context is not None:
        functions.append(("context: rows", action.context.rows, ("belief",)))
        functions.append(("context: may_meet", action.context.may_meet, ("arguments", "rows")))
    given = [each for each in functions if each[1] is not None or each[0] == "controller"]
    faults = [fault for function in given for fault in fault_of_call(*function)]
    yield from faults or _fault_of_arguments(action)


def fault_of_call(name: str, function: Any, arguments: tuple[str, ...]) -> Iterator[str]:
    """Why a function cannot be called with these arguments; nothing if it can, or if it does not tell."""
    if isinstance(function, type):
        yield f"{name} is the class {function.__name__}, expected an object made of it"
        return
    if not callable(function):
        yield f"{name} is {shown(function)}, expected a callable"
        return
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):  # of C code
        return
    try:
        signature.bind(*arguments)
    except TypeError:
        yield f"{name} takes {signature}, expected ({', '.join(arguments)})"


def faults_of_results(domain: Domain) -> Iterator[str]:
    """What the methods of a domain return for the first belief, in place of what is declared."""
    try:
        belief = first_belief(domain)
        updated(domain, belief, 0, (), (0.0,) * len(domain.axes))
        for check in (is_ready, telemetry, relocations, kept_at):
            check(domain, belief)
    except UsageError as error:
        yield str(error).removeprefix(f"the package of {domain.name}: ")


def _fault_of_arguments(action: Action) -> Iterator[str]:
    """`arguments` that makes something else than one row for each row of parameters."""
    ends = [(each.lower, each.upper) for each in action.parameters]
    if not ends or not all(math.isfinite(lower) and lower <= upper < math.inf for lower, upper in ends):
        return  # faults of their own
    lower, upper = np.array(ends).T
    try:
        made: Any = action.arguments(np.random.default_rng(0).uniform(lower, upper, (ROWS, len(ends))))
    except Exception as error:  # code of a package
        yield f"arguments cannot be made: {raised_text(error)}"
        return
    if np.ndim(made) != 2 or len(made) != ROWS:
        returned = f"an array of shape {np.shape(made)}" if isinstance(made, np.ndarray) else shown(made)
        yield f"arguments returns {returned} for {ROWS} rows of parameters, expected {ROWS} rows of arguments"


def _names(function: Callable[..., Any]) -> tuple[str, ...]:
    """Names of a method's arguments, without its object."""
    return tuple(inspect.signature(function).parameters)[1:]
