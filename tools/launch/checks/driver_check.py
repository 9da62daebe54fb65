"""Checks at start-up that a domain and its robot's driver match: same command topic, axes, and limits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.outlet import Outlet, outlets_of
from tailor.schemas.errors import UsageError
from tailor.schemas.installed.package_errors import raised_text
from tailor.schemas.parsed_files import read_toml, shown
from tailor.schemas.topics import MAX_RATE_HZ, TOPICS, is_rate, nominal_rates_hz
from tailor.simnodes.driver import command_values
from tailor.simnodes.driver_spec import DriverSpec, driver_spec, shipped_driver_spec

MIN_FRESH = 2  # messages of a sensor before it is stale, so that it may lose one
COMMAND_KEYS = ("topic", "rate_hz", "timeout_s", "frame", "axes")
AXIS_KEYS = ("name", "unit", "lower", "upper", "kept")
MISPLACED = (*COMMAND_KEYS, "command_topic", "outlets")  # beside the tables, which may be any that people like
SENSOR_KEYS = ("rate_hz", "frame")


def driver_of(domain: Domain, file: str | None) -> DriverSpec:
    """Specification of the driver of a domain's robot: from `file`, or that of the simulated robot.

    Raises:
      UsageError: The file is missing, not a specification of a driver, or that of another robot's.
    """
    if file is None:
        return shipped_driver_spec(domain.robot)
    table = read_toml(file, "the specification of a driver (docs/robots/driver.md)")
    try:
        spec = driver_spec(table)
    except ValueError as error:
        raise UsageError(f"{file}: not the specification of a driver: {error} (docs/robots/driver.md)") from error
    if faults := list(faults_of_table(table, domain)):
        raise UsageError(f"{file}: {'; '.join(faults)} (docs/robots/driver.md)")
    return spec


def faults_of_table(table: Mapping[str, Any], domain: Domain) -> Iterator[str]:
    """What a specification says that nobody reads, such as a misspelt key, or that is of another robot.

    Args:
      table: A specification that `driver_spec` accepts.
      domain: Domain of the robot.
    """
    if table.get("robot", domain.robot) != domain.robot:
        yield f"robot is {shown(table['robot'])}, expected '{domain.robot}'"
    yield from (f"sensors: there is no topic '{name}'" for name in table.get("sensors", {}) if name not in TOPICS)
    both = [each["topic"] for each in _commands(table) if each["topic"] in table.get("sensors", {})]
    yield from (f"{name} is the topic of a command and of a sensor, expected two" for name in both)
    yield from (f"unknown key '{key}', expected it in [command], if at all" for key in MISPLACED if key in table)
    yield from _unknown_keys(table)
    units = {axis.name: axis.unit for axis in domain.axes if axis.unit}
    for axis in (axis for command in _commands(table) for axis in command["axes"]):
        name, unit = axis["name"], axis.get("unit")
        if unit is not None and unit != units.get(name, unit):
            yield f"{name} has the unit {shown(unit)}, expected {units[name]} as the domain"


def _unknown_keys(table: Mapping[str, Any]) -> Iterator[str]:
    commands = _commands(table)
    entries: list[tuple[str, Mapping[str, Any], tuple[str, ...]]] = [
        *((command["topic"], command, COMMAND_KEYS) for command in commands),
        *((axis["name"], axis, AXIS_KEYS) for command in commands for axis in command["axes"]),
        *((f"sensors.{name}", sensor, SENSOR_KEYS) for name, sensor in table.get("sensors", {}).items()),
    ]
    for where, entry, known in entries:
        if unknown := [key for key in entry if key not in known]:
            yield f"{where}: unknown key '{', '.join(unknown)}', expected one of: {', '.join(known)}"


def _commands(table: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    return table.get("commands") or [table["command"]]


def check_driver(domain: Domain, driver: DriverSpec) -> None:
    """Raise UsageError with all mismatches in one line, unless the driver takes and sends what the domain needs."""
    mismatches = mismatches_of(domain, driver)
    if mismatches:
        raise UsageError(f"domain {domain.name} and the driver of {domain.robot} do not match: {'; '.join(mismatches)}")


def sensor_rates_hz(domain: Domain, driver: DriverSpec) -> dict[str, float]:
    """Nominal rates of the sensors that a domain requires, by topic: as declared, else those of the topics."""
    declared = {sensor.topic: sensor.nominal_hz for sensor in driver.sensors}
    return {topic: declared.get(topic, rate_hz) for topic, rate_hz in nominal_rates_hz(domain.required).items()}


def mismatches_of(domain: Domain, driver: DriverSpec) -> list[str]:
    """All reasons why the driver would not accept every command of the domain, or its sensors not be fresh."""
    mismatches = []
    published = tuple(outlet.topic for outlet in outlets_of(domain))
    if published != driver.command_topics:
        expected = ", ".join(driver.command_topics)
        mismatches.append(f"the domain publishes {', '.join(published)}, the driver expects {expected}")
    names = tuple(axis.name for axis in domain.axes)
    if names != driver.axes:
        mismatches.append(f"the domain has the axes {', '.join(names)}, the driver {', '.join(driver.axes)}")
    else:
        mismatches += [
            f"{axis.name} ranges from {axis.lower:g} to {axis.upper:g} {axis.unit}, "
            f"the driver's limits are {limit.lower:g} and {limit.upper:g}"
            for axis, limit in zip(domain.axes, driver.limits, strict=True)
            if not (limit.lower <= axis.lower and axis.upper <= limit.upper)
        ]
        mismatches += [
            f"{axis.name} is {_rest(axis.kept)} at rest, by the driver {_rest(limit.kept)}"
            for axis, limit in zip(domain.axes, driver.limits, strict=True)
            if axis.kept != limit.kept
        ]
    if not mismatches:
        mismatches += _misread(domain, driver)
    return [*mismatches, *_undeclared(domain, driver), *_unfit_rates(domain, driver)]


def _misread(domain: Domain, driver: DriverSpec) -> Iterator[str]:
    """Outlets whose messages the driver reads otherwise than the domain writes them, e.g. with two axes exchanged."""
    outlets = outlets_of(domain)
    if tuple(axis for outlet in outlets for axis in outlet.axes) != domain.axes:
        return  # a fault of the package, which its own check names
    for outlet, declared in zip(outlets, driver.all_outlets(), strict=True):
        ranges, parts = [(axis.lower, axis.upper) for axis in outlet.axes], len(outlet.axes) + 2
        within = tuple(lower + (upper - lower) * (k + 1) / parts for k, (lower, upper) in enumerate(ranges))
        for written in (within, *zip(*ranges, strict=True)):  # also at both ends of all axes
            if fault := _misreading(outlet, written, declared.axes):
                yield f"{outlet.topic}{fault}"
                break


def _misreading(outlet: Outlet, written: tuple[float, ...], axes: tuple[str, ...]) -> str:
    """What the driver reads of a command, if it is another one; empty if it is the same."""
    try:
        read = command_values(outlet.message(written, 0), axes)
    except Exception as error:  # code of a package
        return f": the domain's message cannot be made: {raised_text(error)}"
    if read == written:
        return ""
    values = ", ".join(f"{value:g}" for value in written)
    heard = ", ".join(f"{value:g}" if isinstance(value, int | float) else shown(value) for value in read) or "nothing"
    return f" carries {values} for {', '.join(axes)}, and the driver reads {heard}"


def _undeclared(domain: Domain, driver: DriverSpec) -> Iterator[str]:
    """Required sensors that a list of sensors lacks: a simulator sends them, a driver of hardware refuses them."""
    declared = {sensor.topic for sensor in driver.sensors}
    if declared:
        yield from (
            f"{name} is required, but no sensor of the driver" for name in domain.required if name not in declared
        )


def _unfit_rates(domain: Domain, driver: DriverSpec) -> Iterator[str]:
    for name, rate_hz in sensor_rates_hz(domain, driver).items():
        topic = TOPICS[name]
        if not is_rate(rate_hz):
            yield f"{name} comes at {rate_hz:g} Hz, expected at most {MAX_RATE_HZ:g} and not less than 0"
        elif topic.fresh_s is not None and rate_hz < min(topic.rate_hz, MIN_FRESH / topic.fresh_s):
            least = f"expected at least {MIN_FRESH / topic.fresh_s:g} Hz"
            yield f"{name} comes at {rate_hz:g} Hz, {least}: it is stale after {topic.fresh_s:g} s"


def _rest(kept: float | None) -> str:
    return "zero" if kept is None else f"kept, {kept:g} at first"
