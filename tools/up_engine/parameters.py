"""Parameters of the engine, as people pass them in a dictionary: checked when it is made, not when it plans."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, get_args

from tailor.executive.planning import EngineName, FlawOrder, Settings
from tailor.schemas.errors import UsageError
from tailor.schemas.settings import from_table
from tailor.tools.plan_search.limits import GROUND_LIMIT, MAX_PLANS
from tailor.tools.up_engine import NAME

WHERE = f"engine {NAME}"


def checked(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Arguments of `Settings`; names of flaw orders may be text, and one order or ranking stands for a list of one.

    Raises:
      UsageError: A parameter has no such name, or a value of another type or range.
    """
    engine = parameters.get("engine", "auto")
    if engine not in get_args(EngineName):
        raise UsageError(f"{WHERE}: expected {' or '.join(get_args(EngineName))}, found {engine!r}")
    known = {"ground_limit": GROUND_LIMIT, "node_limit": MAX_PLANS, **parameters}
    for name in ("rankings", "flaw_orders"):
        if isinstance(known.get(name), str):
            known[name] = (known[name],)
    orders = known.get("flaw_orders")
    if isinstance(orders, list | tuple):
        known["flaw_orders"] = tuple(FlawOrder(each) if isinstance(each, str) else each for each in orders)
    made = from_table(Settings, known, WHERE)
    return {name: getattr(made, name) for name in known}
