"""Declaration of a driver in `driver.toml`: its command, and the limits that its guard enforces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tailor.schemas.errors import UsageError
from tailor.schemas.installed import file, spec_of_robot
from tailor.schemas.parsed_files import toml_table
from tailor.schemas.topics import TOPICS
from tailor.simnodes.guard import Limit
from tailor.simnodes.typed_values import finite_number, table_in, tables_in, text

MIN_TIMEOUT_S = 0.1  # from one command of the executive to the next: a guard that waits no longer stops every robot
MAX_TIMEOUT_S = 1.0  # a guard that waits longer for the next command protects nothing


@dataclass(frozen=True, slots=True)
class OutletSpec:
    """One command outlet of a driver, and the names of its axes."""

    topic: str  # name in tailor.schemas.topics
    axes: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class SensorSpec:
    """One sensor of a driver."""

    topic: str  # name in tailor.schemas.topics
    rate_hz: float  # 0: on change, or of the topic's rate
    frame: str = ""  # in the header of its messages; empty: not declared

    @property
    def nominal_hz(self) -> float:
        """The declared rate, or else that of the topic."""
        return self.rate_hz or TOPICS[self.topic].rate_hz


@dataclass(frozen=True, slots=True)
class DriverSpec:
    """A driver's command: its topic, and its axes with their limits, in one order.

    A robot with several command outlets lists them in `outlets`: `axes` and `limits` are those of all, in that order,
    and `command_topic` is that of the first. One guard judges them together.
    """

    command_topic: str  # name in tailor.schemas.topics
    axes: tuple[str, ...]
    limits: tuple[Limit, ...]
    timeout_ns: int = 300_000_000
    outlets: tuple[OutletSpec, ...] = ()
    sensors: tuple[SensorSpec, ...] = ()

    def __post_init__(self) -> None:
        if self.outlets and self.command_topic != self.outlets[0].topic:
            raise ValueError(f"command_topic is {self.command_topic}, expected {self.outlets[0].topic}")

    def all_outlets(self) -> tuple[OutletSpec, ...]:
        """Every outlet: those listed, or the only one."""
        return self.outlets or (OutletSpec(self.command_topic, self.axes),)

    @property
    def command_topics(self) -> tuple[str, ...]:
        """Topics of all outlets."""
        return tuple(outlet.topic for outlet in self.all_outlets())


def shipped_driver_spec(robot: str) -> DriverSpec:
    """The declaration in a robot's package, e.g. `shipped_driver_spec("agilo")`.

    Raises:
      UsageError: There is no such robot, or its file is missing or no declaration; the message names the file.
    """
    spec = spec_of_robot(robot)
    declared = file(spec, "driver")
    try:
        return read_driver_spec(declared.read_text(encoding="utf-8"))
    except OSError as error:
        raise UsageError(f"domain {spec.name}: driver = '{spec.driver}': {error.strerror}") from error
    except ValueError as error:
        raise UsageError(f"{declared}: not the specification of a driver: {error}") from error


def driver_spec_to_run(robot: str) -> DriverSpec:
    """As `shipped_driver_spec`, for a process that is to publish and hear what is declared there.

    Raises:
      UsageError: See `shipped_driver_spec`; also for the name of a topic that nobody declares.
    """
    spec = shipped_driver_spec(robot)
    unknown = [name for name in (*spec.command_topics, *(each.topic for each in spec.sensors)) if name not in TOPICS]
    if unknown:
        declared = file(spec_of_robot(robot), "driver")
        raise UsageError(f"{declared}: there is no topic '{unknown[0]}', expected one of the package or of Tailor")
    return spec


def read_driver_spec(written: str) -> DriverSpec:
    """The declaration in a TOML text.

    Raises:
      ValueError: The text is no TOML, a key is missing or has a value of another type, a limit is not finite, or the
        timeout is not between MIN_TIMEOUT_S and MAX_TIMEOUT_S; the message names the key.
    """
    return driver_spec(toml_table(written))


def driver_spec(table: Mapping[str, Any]) -> DriverSpec:
    """The declaration in a table, see `read_driver_spec`."""
    if "command" in table and "commands" in table:
        raise ValueError("there are [command] and [[commands]], expected one of them: the first would be ignored")
    commands = tables_in(table, "commands") if "commands" in table else [table_in(table, "command")]
    outlets = tuple(OutletSpec(text(each, "topic"), _axis_names(each)) for each in commands)
    names = [name for outlet in outlets for name in (outlet.topic, *outlet.axes)]
    repeated = sorted({name for name in names if names.count(name) > 1})
    if repeated:
        raise ValueError(f"{', '.join(repeated)}: declared twice, expected topics and axes of different names")
    sensors = table_in(table, "sensors") if "sensors" in table else {}
    return DriverSpec(
        command_topic=outlets[0].topic,
        axes=tuple(name for outlet in outlets for name in outlet.axes),
        limits=tuple(_limit(axis) for each in commands for axis in tables_in(each, "axes")),
        timeout_ns=min(_timeout_ns(each) for each in commands),
        outlets=outlets if len(outlets) > 1 else (),
        sensors=tuple(_sensor(name, table_in(sensors, name)) for name in sensors),
    )


def _axis_names(command: Mapping[str, Any]) -> tuple[str, ...]:
    return tuple(text(axis, "name") for axis in tables_in(command, "axes"))


def _sensor(name: str, table: Mapping[str, Any]) -> SensorSpec:
    rate_hz = finite_number(table, "rate_hz") if "rate_hz" in table else 0.0
    if "rate_hz" in table and rate_hz <= 0.0:  # 0 would count as not declared, and give the sensor its topic's rate
        raise ValueError(f"{name}: rate_hz is {rate_hz:g}, expected more than 0; without it the topic's rate holds")
    return SensorSpec(name, rate_hz, text(table, "frame") if "frame" in table else "")


def _timeout_ns(command: Mapping[str, Any]) -> int:
    timeout_s = finite_number(command, "timeout_s")
    if not MIN_TIMEOUT_S < timeout_s <= MAX_TIMEOUT_S:
        expected = f"more than {MIN_TIMEOUT_S:g}, the time between two commands, and at most {MAX_TIMEOUT_S:g}"
        raise ValueError(f"timeout_s is {timeout_s:g}, expected {expected}")
    return round(timeout_s * 1e9)


def _limit(axis: Mapping[str, Any]) -> Limit:
    lower, upper = finite_number(axis, "lower"), finite_number(axis, "upper")
    if lower >= upper:
        raise ValueError(f"{axis['name']} goes from {lower:g} to {upper:g}, expected the lower limit first")
    kept = finite_number(axis, "kept") if "kept" in axis else None
    if kept is not None and not lower <= kept <= upper:
        raise ValueError(f"{axis['name']} is kept at {kept:g}, expected a set-point within its limits")
    return Limit(lower, upper, kept)
