"""Builds a context from names and settings, and its provenance, from which the same context can be rebuilt."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tailor.executive import domains
from tailor.executive.deliberation.context import Context, Settings, make_context
from tailor.executive.interfaces.action import Action, unchanged
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.sequence import InstantiatedAction
from tailor.executive.refinement.objective.stage_models import models_of
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import models_folder, spec_of_robot
from tailor.schemas.settings import from_table
from tailor.schemas.topics import is_rate, key_of

ModelLoader = Callable[[str, str], Models]  # of a robot, from a folder; empty: the shipped one
PLACE_UNIT = "m"


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
    return make_context(domain, scenario, models, config.settings, sender, stamp_offset_ns)


def load_models(robot: str, zoo: str = "") -> Models:
    """Load a robot's action models.

    Raises:
      UsageError: A missing or altered model, one whose training range is smaller than its action's, or one that takes
        other arguments.
    """
    from tailor.models.runtime import load_robot  # and onnxruntime: a simulator or launcher has no use for 30 MB of it

    folder = Path(zoo) if zoo else models_folder(robot)
    durations, successes = load_robot(robot, folder, required_ranges(robot))
    loaded: dict[str, Any] = {**durations, **successes}
    for action in domains.load(spec_of_robot(robot).name).actions.values():
        for path in (action.duration_model, action.success_model):
            if path in loaded and action.arguments is unchanged:
                _check_arguments(action, loaded[path].card, folder / robot / path)
    return Models(durations, successes)


def _check_arguments(action: Action, card: Mapping[str, Any], model: Path) -> None:
    """Raise UsageError unless the parameters of an action are the arguments of its model, in their order."""
    taken = [each["name"] for each in card["arguments"]]
    declared = [parameter.name for parameter in action.parameters]
    if declared != taken:
        raise UsageError(f"{model}: takes {' '.join(taken)}, expected {' '.join(declared)} by the action {action.name}")


def check_models(context: Context) -> None:
    """Raise UsageError, naming action and model, if an action needs a model that is not loaded.

    A tick would find out while the robot is armed. Which ones are needed depends on the settings, too: energy counts
    only where it has a weight.
    """
    missing = []
    for action in context.domain.actions.values():
        try:
            models_of(InstantiatedAction(action, 0, ()), context.models, context.settings.refinement)
        except UsageError as error:
            missing.append(str(error))
    if missing:
        raise UsageError("; ".join(missing))


def required_ranges(robot: str) -> dict[str, dict[str, tuple[float, float]]]:
    """Ranges that a robot's actions declare, by the folder of their models and by parameter.

    Places are left out: models use their distance and direction, which single parameters do not bound.
    """
    ranges: dict[str, dict[str, tuple[float, float]]] = {}
    for action in domains.load(spec_of_robot(robot).name).actions.values():
        declared = ranges.setdefault(action.duration_model.rpartition("/")[0], {})
        for p in (parameter for parameter in action.parameters if parameter.unit != PLACE_UNIT):
            lower, upper = declared.get(p.name, (p.lower, p.upper))
            declared[p.name] = min(lower, p.lower), max(upper, p.upper)
    return ranges


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
