"""Checks the scenario files of a robot's package, before a run draws one of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib.resources.abc import Traversable
from typing import Any

import numpy as np

from tailor.executive import domains
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import file, part
from tailor.schemas.packages.spec import DomainSpec
from tailor.schemas.parsed_files import shown


def faults_of_scenarios(spec: DomainSpec) -> Iterator[str]:
    """All faults of a package's scenarios, each with file and field."""
    folder = None if spec.generator else file(spec, "scenarios")
    if folder is not None and folder.is_dir():
        names = sorted(entry.name for entry in folder.iterdir() if entry.name.endswith(".toml"))
        found = [f"{spec.scenarios}/{name}: {fault}" for name in names for fault in _faults_of_file(spec, folder, name)]
        if found:
            yield from found
            return
    try:
        known = domains.scenarios(spec.name)
    except UsageError as error:
        yield str(error)
        return
    if not known:
        yield f"{spec.generator or spec.scenarios}: there is no scenario"


def _faults_of_file(spec: DomainSpec, folder: Traversable, name: str) -> Iterator[str]:
    """Faults of a scenario file: of the entries that Tailor reads, else of a trial of `draw`, which reads the rest."""
    try:
        declared = domains.declaration(spec, name.removesuffix(".toml"))
    except ValueError as error:
        yield str(error)
        return
    found = [*_faults_of_entries(folder, declared)]
    yield from found or _faults_of_draw(spec, declared)


def _faults_of_entries(folder: Traversable, declared: Mapping[str, Any]) -> Iterator[str]:
    order, problem = declared.get("order", 0), declared.get("problem")
    if isinstance(order, bool) or not isinstance(order, int | float):
        yield f"order is {shown(order)}, expected a number"
    if not isinstance(problem, str):
        yield f"problem is {'missing' if problem is None else shown(problem)}, expected the name of a PDDL file"
    elif not folder.joinpath(problem).is_file():
        yield f"problem is {shown(problem)}, expected a file beside it"
    settings = declared.get("settings", {})
    if not isinstance(settings, dict):
        yield f"settings is {shown(settings)}, expected a table"


def _faults_of_draw(spec: DomainSpec, declared: Mapping[str, Any]) -> Iterator[str]:
    """What `draw`, code of the package, raises for an entry that is missing or has a value of another type."""
    draw = part(spec, "draw")
    try:
        _start, _places, _events = draw(declared, np.random.default_rng(0))
    except Exception as error:
        yield f"cannot be drawn: {type(error).__name__}: {error}"
