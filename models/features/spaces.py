"""The feature spaces that packages of robots declare, by name. Models of one robot may use those of another."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

from tailor.models.features.features import FeatureSpace
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import domain_names, part, spec_of


def feature_spaces() -> Mapping[str, FeatureSpace]:
    """All usable feature spaces by name, in the order of their domains."""
    return _read()[0]


def feature_space(name: str) -> FeatureSpace:
    """Feature space of a name.

    Raises:
      UsageError: There is none; the message lists the known ones, and what is wrong with others.
    """
    known, faults = _read()
    if name not in known:
        raise UsageError("; ".join([f"no feature space '{name}' (expected one of: {', '.join(known)})", *faults]))
    return known[name]


@cache
def _read() -> tuple[dict[str, FeatureSpace], tuple[str, ...]]:
    """Usable spaces, and faults of packages whose spaces are not."""
    known: dict[str, FeatureSpace] = {}
    faults: list[str] = []
    for spec in map(spec_of, domain_names()):
        if not spec.features:
            continue
        try:
            declared = part(spec, "features")
        except UsageError as error:
            faults.append(str(error))
            continue
        wrong = [f"domain {spec.name}: features = '{spec.features}': {fault}" for fault in _faults(declared, known)]
        known.update({} if wrong else {space.name: space for space in declared})
        faults.extend(wrong)
    return known, tuple(faults)


def _faults(declared: Any, known: Mapping[str, FeatureSpace]) -> Iterator[str]:
    if not isinstance(declared, tuple) or not all(isinstance(space, FeatureSpace) for space in declared):
        yield f"is {declared!r:.80}, expected a tuple of FeatureSpaces"
        return
    for space in declared:
        if known.get(space.name, space) is not space:
            yield f"'{space.name}' is the name of another feature space"
