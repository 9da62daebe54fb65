"""Parameters of the engine, as people pass them in a dictionary: checked when it is made, not when it plans."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, get_args

from tailor.executive.planning import EngineName, FlawOrder, Settings
from tailor.schemas.errors import UsageError
from tailor.tools.plan_search.limits import GROUND_LIMIT, MAX_PLANS
from tailor.tools.up_engine import NAME

NAMES = [field.name for field in fields(Settings)]


def checked(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Arguments of `Settings`; names of flaw orders may be text.

    Raises:
      UsageError: A parameter has no such name, or a value of another type or range.
    """
    for name in parameters:
        if name not in NAMES:
            raise UsageError(f"engine {NAME}: expected a parameter of memory_mb, {', '.join(NAMES)}; found {name!r}")
    engine = parameters.get("engine", "auto")
    if engine not in get_args(EngineName):
        raise UsageError(f"engine {NAME}: expected {' or '.join(get_args(EngineName))}, found {engine!r}")
    known = {"ground_limit": GROUND_LIMIT, "node_limit": MAX_PLANS, **parameters}
    for name in ("rankings", "flaw_orders"):
        if name in known:
            known[name] = _texts(name, known[name])
    if "flaw_orders" in known:
        known["flaw_orders"] = tuple(FlawOrder(o) if isinstance(o, str) else o for o in known["flaw_orders"])
    try:
        Settings(**known)
    except (TypeError, ValueError, AttributeError) as reason:
        raise UsageError(f"engine {NAME}: a parameter has a value of another type: {reason}") from None
    return known


def _texts(name: str, value: Any) -> tuple[Any, ...]:
    """A list as a tuple; one text is a list of one, not of its letters."""
    if isinstance(value, str):
        return (value,)
    if not isinstance(value, (list, tuple)):
        raise UsageError(f"engine {NAME}: expected {name} to be a list, found {value!r}")
    return tuple(value)
