"""Puts a context together from names and settings, and writes down what it was made of so that it can be made again."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tailor.executive import domains
from tailor.executive.core.context import Context, Settings, make_context
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.gate import check_gate
from tailor.models.runtime import GATE, load_gate, load_robot
from tailor.schemas.errors import UsageError
from tailor.schemas.settings import from_table

PLACE_UNIT = "m"


@dataclass(frozen=True, slots=True)
class ExecutiveConfig:
    """What to run: a domain, one of its scenarios, and the settings of the executive."""

    domain: str
    scenario: str
    settings: Settings = field(default_factory=Settings)
    zoo: str = ""  # folder of action models; empty: those that ship


def build_context(config: ExecutiveConfig, sender: str, stamp_offset_ns: int = 0) -> Context:
    """Build the context of a configuration.

    Raises:
      UsageError: Unknown domain or scenario, a PDDL error, a missing or altered model.
    """
    domain = domains.load(config.domain)
    scenario, _ = domains.seeded_scenario(config.domain, config.scenario, config.settings.seed)
    models = load_models(domain.robot, config.zoo, config.settings.refinement.gate)
    return make_context(domain, scenario, models, config.settings, sender, stamp_offset_ns)


def load_models(robot: str, zoo: str = "", gated: bool = False) -> Models:
    """A robot's models, with its refinement gate if `gated` and there is one.

    Raises:
      UsageError: A missing or altered model, one that has not seen what its action asks for, or a refinement gate that
        was learned with others.
    """
    folder = Path(zoo) if zoo else None
    durations, successes = load_robot(robot, folder, required_ranges(robot))
    gate = load_gate(robot, folder, {**durations, **successes}) if gated else None
    return Models(durations, successes, None if gate is None else check_gate(gate))


def required_ranges(robot: str) -> dict[str, dict[str, tuple[float, float]]]:
    """Ranges that a robot's actions declare, by the folder of their models and argument.

    Places are left out: models know them by distance and direction, and how far apart two may be the arguments do not
    say one by one.
    """
    ranges: dict[str, dict[str, tuple[float, float]]] = {}
    for domain in filter(lambda domain: domain.robot == robot, map(domains.load, domains.DOMAINS)):
        for action in domain.actions.values():
            known = ranges.setdefault(action.duration_model.rpartition("/")[0], {})
            for asked in (parameter for parameter in action.parameters if parameter.unit != PLACE_UNIT):
                lower, upper = known.get(asked.name, (asked.lower, asked.upper))
                known[asked.name] = min(lower, asked.lower), max(upper, asked.upper)
    return ranges


def provenance(config: ExecutiveConfig, context: Context) -> dict[str, Any]:
    """All that it takes to compose the same context again, and the cards of the models it used."""
    models: dict[str, Any] = {**context.models.durations, **context.models.successes}
    if context.models.gate is not None:
        models[GATE] = context.models.gate
    return {
        "config": dataclasses.asdict(config),
        "sender": context.sender,
        "stamp_offset_ns": context.stamp_offset_ns,
        "models": {name: model.card["sha256"] for name, model in sorted(models.items())},
    }


def without_gate(config: ExecutiveConfig) -> ExecutiveConfig:
    """The configuration of a run that always refines."""
    refinement = dataclasses.replace(config.settings.refinement, gate=False)
    return dataclasses.replace(config, settings=dataclasses.replace(config.settings, refinement=refinement))


def rebuild_context(recorded: Mapping[str, Any]) -> Context:
    """The context that a recording's provenance describes; raises UsageError if the models here are not those."""
    _check(recorded)
    config = from_table(ExecutiveConfig, recorded["config"], "recording's provenance")
    if GATE not in recorded["models"]:  # the run had no refinement gate, whatever is installed here
        config = without_gate(config)
    context = build_context(config, recorded["sender"], recorded["stamp_offset_ns"])
    here = provenance(config, context)["models"]
    for name, sha256 in recorded["models"].items():
        if here.get(name) != sha256:
            found = str(here.get(name, "missing"))[:12]
            raise UsageError(f"model {name} is {found} here, but the recording was made with {str(sha256)[:12]}")
    return context


def _check(recorded: Mapping[str, Any]) -> None:
    """Whether a provenance has what `rebuild_context` needs: it comes from a file."""
    if not recorded:
        raise UsageError("the recording does not say what the executive was made of, expected exec/provenance in it")
    kinds = {"config": dict, "sender": str, "stamp_offset_ns": int, "models": dict, "machine": dict}
    for name, kind in kinds.items():
        found = recorded.get(name, {} if name == "machine" else None)  # nothing was said of machines once
        if not isinstance(found, kind):
            raise UsageError(f"recording's provenance: '{name}' is {found!s:.40}, expected {kind.__name__}")
