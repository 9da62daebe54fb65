"""Facts of a run from its provenance: domain, robot, scenario, names of belief values, command limits."""

from __future__ import annotations

from typing import Any

from tailor.schemas.errors import Rejected, UsageError
from tailor.schemas.parsed_files import table_of
from tailor.tools.viewer.event_fields import Fields

# Limits that the page draws; the executive's shell keeps them (architecture.md, "One tick").
TIMES_MS = {"period": 100, "budget": 60, "end": 80}


def run_facts(provenance: str) -> Fields:
    """Facts of the page from the JSON of a `Provenance` message; missing ones and those of other types are left out."""
    config = _table(_loads(provenance).get("config"))
    settings = _table(config.get("settings"))
    facts = {
        "domain": _of_type(str, config.get("domain")),
        "scenario": _of_type(str, config.get("scenario")),
        "seed": _of_type(int, settings.get("seed")),
        "horizon": _of_type(int, _table(settings.get("refinement")).get("horizon")),
    }
    return {"times": TIMES_MS} | {k: v for k, v in facts.items() if v not in (None, "")} | _domain(facts["domain"])


def _of_type(kind: type, value: Any) -> Any:
    """The value; None if it is of another type, such as NaN, which Python reads from JSON and no page would."""
    return value if isinstance(value, kind) else None


def _domain(name: Any) -> Fields:
    """Facts of the domain; none if it is not installed."""
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
