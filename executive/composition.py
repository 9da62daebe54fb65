"""Builds a context from names and settings, and its provenance, from which the same context can be rebuilt."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from tailor.executive import domains
from tailor.executive.deliberation.context import Context, Settings, make_context
from tailor.executive.interfaces.models import Models
from tailor.executive.robot_models import load_models
from tailor.schemas.errors import UsageError
from tailor.schemas.settings import from_table
from tailor.schemas.topics import is_rate, key_of

ModelLoader = Callable[[str, str], Models]  # of a robot, from a folder; empty: the shipped one


@dataclass(frozen=True, slots=True)
class ExecutiveConfig:
    """Configuration of the executive: a domain, one of its scenarios, settings, models.

    Attributes:
      domain: Name, see tailor.schemas.installed.domain_names.
      scenario: Name of one of the domain's scenarios.
      settings: Settings of the executive; their seed also draws the scenario.
      zoo: Folder of action models; empty: the shipped ones.
    """

    domain: str
    scenario: str
    settings: Settings = field(default_factory=Settings)
    zoo: str = ""


def build_context(
    config: ExecutiveConfig, sender: str, stamp_offset_ns: int = 0, load: ModelLoader | None = None
) -> Context:
    """Build the context of a configuration.

    Args:
      config: Names and settings.
      sender: Sender id of this executive, 32 hex digits.
      stamp_offset_ns: Added to the monotonic time for the stamps of messages.
      load: Loads the models; None: `load_models`.

    Raises:
      UsageError: Unknown domain or scenario, a PDDL error, a missing or altered model.
    """
    domain = domains.load(config.domain)
    scenario, _ = domains.seeded_scenario(config.domain, config.scenario, config.settings.seed)
    models = (load or load_models)(domain.robot, config.zoo)
    doubts = domains.doubts(config.domain)
    return make_context(domain, scenario, models, config.settings, sender, stamp_offset_ns, doubts)


def provenance(config: ExecutiveConfig, context: Context) -> dict[str, Any]:
    """Data from which `rebuild_context` builds the same context; models by the hash of their cards.

    `required`: keys without which the executive holds, e.g. "agilo/odom", with their nominal rates in Hz.
    """
    models: dict[str, Any] = {**context.models.durations, **context.models.successes}
    return {
        "config": dataclasses.asdict(config),
        "sender": context.sender,
        "stamp_offset_ns": context.stamp_offset_ns,
        "driver_sender": context.driver_sender,
        "models": {name: model.card["sha256"] for name, model in sorted(models.items())},
        "required": _required(context),
    }


def _required(context: Context) -> dict[str, float]:
    return {key_of(name, context.domain.robot): rate_hz for name, rate_hz in context.sensor_rates_hz.items()}


def rebuild_context(recorded: Mapping[str, Any], load: ModelLoader | None = None) -> Context:
    """Build the context that a recording's provenance describes.

    Args:
      recorded: The provenance.
      load: Loads the models; None: `load_models`.

    Raises:
      UsageError: The provenance is incomplete, or a model here differs from the recorded one.
    """
    _check(recorded)
    config = from_table(ExecutiveConfig, recorded["config"], "recording's provenance")
    context = build_context(config, recorded["sender"], recorded["stamp_offset_ns"], load)
    driver_sender, required = str(recorded.get("driver_sender", "")), recorded.get("required", {})  # newer than others
    names = {name: key_of(name, context.domain.robot) for name in context.domain.required}
    recorded_hz = {name: float(required[key]) for name, key in names.items() if key in required}
    rates_hz = {**context.sensor_rates_hz, **recorded_hz}
    context = dataclasses.replace(context, driver_sender=driver_sender, sensor_rates_hz=rates_hz)
    here = provenance(config, context)["models"]
    for name, sha256 in recorded["models"].items():
        if here.get(name) != sha256:
            found = str(here.get(name, "missing"))[:12]
            raise UsageError(f"model {name} is {found} here, but the recording was made with {str(sha256)[:12]}")
    return context


def _check(recorded: Mapping[str, Any]) -> None:
    """Raise UsageError if a provenance, read from a file, lacks an entry that `rebuild_context` needs."""
    if not recorded:
        raise UsageError("the recording holds no exec/provenance, from which the executive is rebuilt")
    kinds = {"config": dict, "sender": str, "stamp_offset_ns": int, "models": dict, "machine": dict, "required": dict}
    for name, kind in kinds.items():
        value = recorded.get(name, {} if name in ("machine", "required") else None)  # which older recordings lack
        if not isinstance(value, kind):
            raise UsageError(f"recording's provenance: '{name}' is {value!s:.40}, expected {kind.__name__}")
    if not all(is_rate(rate_hz) for rate_hz in recorded.get("required", {}).values()):
        raise UsageError("recording's provenance: 'required' has a value that is no rate in Hz")
