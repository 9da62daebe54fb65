"""The licence of what a robot's package holds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from importlib.metadata import PackageNotFoundError, metadata, packages_distributions

from tailor.schemas.installed import robot_names, spec_of_robot

UNKNOWN = "unknown"  # the hub's own word


def licence_of(robot: str) -> str:
    """SPDX id of the robot's package in lower case, as the hub writes it; "unknown" if the package declares none."""
    if robot not in robot_names():
        return UNKNOWN
    module = spec_of_robot(robot).package.split(".")[0]
    try:
        declared = metadata(next(iter(_distributions().get(module, [module]))))
    except PackageNotFoundError:
        return UNKNOWN
    return declared["License-Expression"].lower() if "License-Expression" in declared else UNKNOWN


@cache
def _distributions() -> Mapping[str, Sequence[str]]:
    """Distributions by module; read once a process, as it takes 0.2 s."""
    return packages_distributions()
