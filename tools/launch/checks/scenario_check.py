"""Checks the scenario files of a robot's package, before a run draws one of them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib.resources.abc import Traversable
from typing import Any

import numpy as np

from tailor.executive import domains, planning
from tailor.executive.interfaces.domain import Scenario
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import file, part
from tailor.schemas.installed.package_errors import raised_text
from tailor.schemas.packages.spec import DomainSpec
from tailor.schemas.parsed_files import shown


def faults_of_scenarios(spec: DomainSpec, pddl: planning.Domain | None) -> Iterator[str]:
    """All faults of a package's scenarios, each with file and field; without its PDDL domain, none in problems."""
    folder = None if spec.generator else file(spec, "scenarios")
    if folder is not None and folder.is_dir():
        names = sorted(entry.name for entry in folder.iterdir() if entry.name.endswith(".toml"))
        files = _ScenarioFiles(spec, pddl, folder)
        found = [f"{spec.scenarios}/{name}: {fault}" for name in names for fault in files.faults(name)]
        if found:
            yield from found
            return
    try:
        known: Any = domains.scenarios(spec.name)
    except UsageError as error:
        yield str(error)
        return
    except Exception as error:  # code of a package's generator
        yield f"{spec.generator}: scenarios cannot be listed: {raised_text(error, spec)}"
        return
    if not known:
        yield f"{spec.generator or spec.scenarios}: there is no scenario"
    elif spec.generator:
        yield from (f"{spec.generator}: {fault}" for fault in _faults_of_generator(spec, known))


def _faults_of_generator(spec: DomainSpec, known: Any) -> Iterator[str]:
    """What a generator returns in place of names, and of its first scenario."""
    if not isinstance(known, list | tuple) or not all(isinstance(name, str) for name in known):
        yield f"scenarios returned {shown(known)}, expected a list of names"
        return
    try:
        drawn = part(spec, "generator").load_scenario(known[0], np.random.default_rng(0))
    except Exception as error:
        yield f"{known[0]} cannot be drawn: {raised_text(error, spec)}"
        return
    if not (isinstance(drawn, tuple | list) and len(drawn) == 2 and isinstance(drawn[0], Scenario)):
        yield f"load_scenario returned {shown(drawn)}, expected (Scenario, start)"


@dataclass(frozen=True, slots=True)
class _ScenarioFiles:
    spec: DomainSpec
    pddl: planning.Domain | None
    folder: Traversable

    def faults(self, name: str) -> Iterator[str]:
        """Faults of a file: of the entries that Tailor reads, else of `draw` and of the problem."""
        try:
            declared = domains.declaration(self.spec, name.removesuffix(".toml"))
        except ValueError as error:
            yield str(error)
            return
        found = [*_faults_of_entries(self.folder, declared)]
        yield from found or (*self._faults_of_draw(declared), *self._faults_of_problem(declared["problem"]))

    def _faults_of_draw(self, declared: Mapping[str, Any]) -> Iterator[str]:
        """What `draw`, code of the package, raises for an entry that is missing or has a value of another type."""
        draw = part(self.spec, "draw")
        try:
            drawn = draw(declared, np.random.default_rng(0))
            if not (isinstance(drawn, tuple | list) and len(drawn) == 3):
                yield f"draw returned {shown(drawn)}, expected (start, places, events)"
                return
            start, places, events = drawn
            values = {**start, **{f"{p}.{q}": v for p, place in places.items() for q, v in place.items()}}
            values |= {f"event {k}.{name}": each[name] for k, each in enumerate(events) for name in {**each, "at_s": 0}}
            infinite = [name for name, value in values.items() if not math.isfinite(value)]
        except Exception as error:
            yield f"cannot be drawn: {type(error).__name__}: {error}"
        else:
            yield from (f"{name} is drawn as {values[name]}, expected a finite number" for name in infinite)

    def _faults_of_problem(self, name: str) -> Iterator[str]:
        try:
            text = self.folder.joinpath(name).read_text(encoding="utf-8")
            if self.pddl is not None:
                planning.parse_problem(text, self.pddl, source=name)
        except UnicodeDecodeError:
            yield f"{name}: not UTF-8"
        except planning.PddlError as error:
            yield str(error)


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
