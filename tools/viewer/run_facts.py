"""What a run's provenance says of it: domain, robot, scenario, names of the belief's values, limits of the command."""

from __future__ import annotations

from typing import Any

from tailor.schemas.errors import Rejected, UsageError
from tailor.schemas.json_text import table_of
from tailor.tools.viewer.event_fields import Fields

# What the page draws as lines; the executive's shell keeps to them (architecture.md, "One tick").
TIMES_MS = {"period": 100, "budget": 60, "end": 80}


def about(provenance: str) -> Fields:
    """The page's facts from a `Provenance` message's JSON; what it does not say is left out."""
    order = _table(_loads(provenance).get("order"))
    settings = _table(order.get("settings"))
    said = {
        "domain": order.get("domain"),
        "scenario": order.get("scenario"),
        "seed": settings.get("seed"),
        "horizon": _table(settings.get("refinement")).get("horizon"),
    }
    return {"times": TIMES_MS} | {k: v for k, v in said.items() if v not in (None, "")} | _domain(said["domain"])


def _domain(name: Any) -> Fields:
    """What only the domain's own folder knows; nothing of it when this installation has no such domain."""
    from tailor.executive import domains

    if not isinstance(name, str):
        return {}
    try:
        domain = domains.load(name)
    except UsageError:
        return {}
    axes = [{"name": a.name, "unit": a.unit, "lower": a.lower, "upper": a.upper} for a in domain.axes]
    return {"robot": domain.robot, "beliefNames": list(domain.belief_names), "axes": axes}


def _loads(text: str) -> dict[str, Any]:
    table = table_of(text)
    return {} if isinstance(table, Rejected) else table


def _table(value: Any) -> dict[str, Any]:
    return value if isinstance(value, dict) else {}
