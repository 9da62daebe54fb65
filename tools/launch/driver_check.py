"""Holds a domain against its robot's driver before anything moves: same command, same axes, limits within limits."""

from __future__ import annotations

from pathlib import Path

from tailor.executive.interfaces.domain import Domain
from tailor.schemas.errors import UsageError
from tailor.simnodes.driver_spec import DriverSpec, read_driver_spec, shipped_driver_spec


def driver_of(robot: str, file: str | None) -> DriverSpec:
    """The driver's declaration: a file, or what ships with the simulated robot.

    Raises:
      UsageError: The file is missing or is no declaration.
    """
    if file is None:
        return shipped_driver_spec(robot)
    try:
        return read_driver_spec(Path(file).read_text(encoding="utf-8"))
    except OSError as error:
        raise UsageError(f"{file}: {error.strerror}, expected a driver's declaration") from error
    except (KeyError, TypeError, ValueError) as error:
        raise UsageError(
            f"{file}: {error}, expected a driver's declaration such as simnodes/agilo/driver.toml"
        ) from error


def check_driver(domain: Domain, driver: DriverSpec) -> None:
    """Raise UsageError, all mismatches in one line, unless the driver takes every command that the domain may send."""
    wrong = []
    if domain.command_topic != driver.command_topic:
        wrong.append(f"the domain commands {domain.command_topic}, the driver takes {driver.command_topic}")
    names = tuple(axis.name for axis in domain.axes)
    if names != driver.axes:
        wrong.append(f"the domain has the axes {', '.join(names)}, the driver {', '.join(driver.axes)}")
    else:
        wrong += [
            f"{axis.name} goes from {axis.lower:g} to {axis.upper:g} {axis.unit}, "
            f"the driver's limits are {limit.lower:g} and {limit.upper:g}"
            for axis, limit in zip(domain.axes, driver.limits, strict=True)
            if not (limit.lower <= axis.lower and axis.upper <= limit.upper)
        ]
    if wrong:
        raise UsageError(f"domain {domain.name} and the driver of {domain.robot} do not match: {'; '.join(wrong)}")
