"""Spaces of actions and observations, from what a domain declares: axes with limits, belief, arguments of actions."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from gymnasium.spaces import Box

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.values import Array, Belief
from tailor.schemas.errors import UsageError
from tailor.simnodes.driver_spec import DriverSpec

Command = tuple[float, ...]


def command_space(domain: Domain, spec: DriverSpec) -> Box:
    """Commands of all axes of all outlets, shape (axes,), in their units: within the limits of domain and guard.

    Axes are in the domain's order. Numbers are float64, so that a controller's own command passes unchanged.
    """
    guarded = dict(zip(spec.axes, spec.limits, strict=True))
    limits = [(axis, guarded.get(axis.name)) for axis in domain.axes]
    lower = [axis.lower if limit is None else max(axis.lower, limit.lower) for axis, limit in limits]
    upper = [axis.upper if limit is None else min(axis.upper, limit.upper) for axis, limit in limits]
    return Box(np.array(lower), np.array(upper), dtype=np.float64)


def numbers(count: int) -> Box:
    """So many numbers without bounds: an estimate may lie anywhere."""
    return Box(-math.inf, math.inf, (count,), dtype=np.float64)


def clipped(space: Box, action: Any) -> Command:
    """A command within the limits.

    Raises:
      ValueError: It has another shape, or a value that is not finite.
    """
    command = np.asarray(action, dtype=np.float64)
    if command.shape != space.shape or not np.isfinite(command).all():
        raise ValueError(f"action is {action!r}, expected {space.shape[0]} finite numbers")
    return tuple(np.clip(command, space.low, space.high).tolist())


def believed(domain: Domain, belief: Belief) -> Array:
    """State variables of the belief (Table 5), shape (names,); 0 for what is not there to describe."""
    return padded(domain.belief_values(belief), len(domain.belief_names))


def width(action: Action) -> int:
    """Number of the arguments of an action's controller and models."""
    lower = np.array([[parameter.lower for parameter in action.parameters]])
    return int(action.arguments(lower).shape[1])


def checked_limit(limit_s: float) -> float:
    """A time limit of an episode, s.

    Raises:
      UsageError: It is no finite number above 0: a failure costs the rest of it.
    """
    if not 0 < limit_s < math.inf:
        raise UsageError(f"limit_s is {limit_s!r}, expected seconds above 0, finite: a failure costs what is left")
    return limit_s


def checked_arguments(action: Action, given: Any) -> Array:
    """Arguments that a caller gives an action's controller, shape (k,).

    Raises:
      UsageError: They are not so many finite numbers.
    """
    count = width(action)
    try:
        row = np.array(given, dtype=np.float64)
    except (TypeError, ValueError):
        row = np.empty(0)
    if row.shape != (count,) or not np.isfinite(row).all():
        raise UsageError(f"arguments of {action.name} are {given!r}, expected {count} finite numbers")
    return row


def padded(values: Any, length: int) -> Array:
    """Values followed by zeros, shape (length,)."""
    row = np.zeros(length)
    row[: len(values)] = values
    return row


def only_option(options: Mapping[str, Any] | None, name: str) -> Any:
    """Value of the one option that `reset` takes, or None.

    Raises:
      UsageError: There are others: a misspelt one would draw at random what it was to set.
    """
    given = options or {}
    if unknown := [each for each in given if each != name]:
        raise UsageError(f"options of reset: unknown {', '.join(map(repr, unknown))}, expected {name!r} or none")
    return given.get(name)
