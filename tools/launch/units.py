"""Unit files of systemd for one robot: bus, driver, executive, recorder, and a target that groups them.

No unit has a leave to arm, and the executive starts without a goal: after every start a person arms and sets the goal.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from tailor.runtime import realtime
from tailor.runtime.processes.child import tailor
from tailor.tools.launch import unit_settings
from tailor.tools.launch.processes import EXECUTIVE_SILENCE_NS, RECORDER_SILENCE_NS, SIM_SILENCE_NS
from tailor.tools.launch.unit_text import command_line, path, path_in_list, unit_text

Setting = tuple[str, str]
TARGET = "tailor.target"
PARTS = ("bus", "recorder", "driver", "executive")  # in the order of their starts
FILE_S = 3600  # of a recording; then the next file begins
BUS_SILENCE_NS: int | None = None  # `tailor bus` reports nothing yet
BUS_CONNECTIONS = 16_384  # file descriptors: a port scan must not use them up


@dataclass(frozen=True, slots=True)
class UnitsConfig:
    """What the units of one machine run."""

    domain: str
    robot: str
    user: str
    endpoint: str
    bus_flags: tuple[str, ...]  # --connect and --config as each command takes them
    parts: tuple[str, ...]
    scenario: str = ""
    record: str = ""  # folder of the recordings
    driver_command: tuple[str, ...] = ()  # of a hardware driver; empty: the simulator
    driver_file: str = ""  # its specification


def unit_files(config: UnitsConfig) -> dict[str, str]:
    """Text of each unit file, by its name."""
    builders = {"bus": _bus, "recorder": _recorder, "driver": _driver, "executive": _executive}
    services = {_name(part): builders[part](config) for part in PARTS if part in config.parts}
    target = {
        "Unit": [("Description", f"Tailor: {config.domain} with {config.robot}"), *(("Wants", s) for s in services)],
        "Install": [("WantedBy", "multi-user.target")],
    }
    return {**services, TARGET: unit_text("All services of the robot on this machine.", target)}


def _bus(config: UnitsConfig) -> str:
    settings = [
        ("RuntimeDirectory", unit_settings.RUN_FOLDER),
        ("RuntimeDirectoryMode", "0750"),
        ("RuntimeDirectoryPreserve", "restart"),
        ("LimitRTPRIO", str(realtime.BUS_PRIORITY)),
        ("LimitNOFILE", str(BUS_CONNECTIONS)),
        ("OOMScoreAdjust", "-800"),
        ("PrivateDevices", "yes"),
        *unit_settings.network(config.endpoint),
    ]
    return _unit(config, "bus", "Router of the bus.", tailor("bus", *config.bus_flags), BUS_SILENCE_NS, settings)


def _recorder(config: UnitsConfig) -> str:
    command = tailor("record", "--quiet", "--max-duration", str(FILE_S), *config.bus_flags)
    settings = [
        ("WorkingDirectory", path(config.record)),
        ("ReadWritePaths", path_in_list(config.record)),
        ("OOMScoreAdjust", "500"),
        ("PrivateDevices", "yes"),
        *unit_settings.network(config.endpoint),
    ]
    return _unit(config, "recorder", "Records every message.", command, RECORDER_SILENCE_NS, settings)


def _driver(config: UnitsConfig) -> str:
    settings = [("LimitRTPRIO", str(realtime.DRIVER_PRIORITY)), ("OOMScoreAdjust", "-900")]
    if config.driver_command:  # it may need devices and the robot's network, and need not report to systemd
        return _unit(config, "driver", "Driver of the robot.", config.driver_command, None, settings)
    settings += [("PrivateDevices", "yes"), *unit_settings.network(config.endpoint)]
    command = tailor("sim", config.robot, *_scenario(config), *config.bus_flags)
    return _unit(config, "driver", "Simulated robot.", command, SIM_SILENCE_NS, settings)


def _executive(config: UnitsConfig) -> str:
    own_driver = ("--driver", config.driver_file) if config.driver_file else ()
    command = tailor("executive", config.domain, "--wait", *_scenario(config), *own_driver, *config.bus_flags)
    settings = [
        ("LimitRTPRIO", str(realtime.PRIORITY)),
        ("LimitMEMLOCK", "infinity"),
        ("OOMScoreAdjust", "-500"),
        ("PrivateDevices", "yes"),
        *unit_settings.network(config.endpoint),
    ]
    return _unit(config, "executive", "The executive; it waits for a goal.", command, EXECUTIVE_SILENCE_NS, settings)


def _unit(
    config: UnitsConfig, part: str, comment: str, command: Sequence[str], silence_ns: int | None, own: Iterable[Setting]
) -> str:
    sections = {
        "Unit": [
            ("Description", f"Tailor {part}: {config.domain} with {config.robot}"),
            ("PartOf", TARGET),
            *_order(config, part),
            *unit_settings.restart_limits(),
        ],
        "Service": [
            ("ExecStart", command_line(command)),
            ("User", config.user),
            *unit_settings.environment(),
            *unit_settings.supervision(silence_ns),
            *own,
            *unit_settings.HARDENING,
        ],
    }
    return unit_text(comment, sections)


def _order(config: UnitsConfig, part: str) -> Iterator[Setting]:
    """Start after the parts before it, stop before them. A new bus has new credentials: all others start anew, too."""
    for earlier in PARTS[: PARTS.index(part)]:
        if earlier in config.parts:
            yield "After", _name(earlier)
    if part == "bus":
        yield "After", "network-online.target"
        yield "Wants", "network-online.target"
    elif "bus" in config.parts:
        yield "Requires", _name("bus")  # not BindsTo: it ends a quick service at once, and nothing starts that again


def _scenario(config: UnitsConfig) -> tuple[str, ...]:
    return ("--scenario", config.scenario) if config.scenario else ()


def _name(part: str) -> str:
    return f"tailor-{part}.service"
