"""Unit files of systemd for one robot: bus, driver, executive, recorder, and a target that groups them.

No unit has a leave to arm, and the executive starts without a goal: after every start a person arms and sets the goal.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from tailor.runtime import realtime
from tailor.runtime.processes.child import tailor
from tailor.schemas.ros2.profiles import PLAIN
from tailor.tools.cli.systems.bus_settings import BusSettings
from tailor.tools.launch.hosting import GATEWAY_SILENCE_NS
from tailor.tools.launch.processes import EXECUTIVE_SILENCE_NS, RECORDER_SILENCE_NS, SIM_SILENCE_NS
from tailor.tools.launch.units import unit_settings
from tailor.tools.launch.units.unit_text import command_line, path, path_in_list, unit_text

Setting = tuple[str, str]
TARGET = "tailor.target"
PARTS = ("bus", "recorder", "driver", "executive")  # in the order of their starts
FILE_S = 3600  # of a recording; then the next file begins
BUS_CONNECTIONS = 16_384  # file descriptors: a port scan must not use them up


@dataclass(frozen=True, slots=True)
class UnitsConfig:
    """What the units of one machine run."""

    domain: str
    robot: str
    user: str
    bus: BusSettings
    parts: tuple[str, ...]
    deployment_file: str = ""
    scenario: str = ""
    zoo: str = ""  # folder of action models; empty: those that ship with Tailor
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
        *(() if config.bus.remote else unit_settings.network(config.bus.endpoint)),
    ]
    remote = ("--secure", config.bus.remote, "--keys", config.bus.keys) if config.bus.remote else ()
    command = tailor("bus", "--security", config.bus.security, *remote, *_bus_flags(config))
    return _unit(config, "bus", "Router of the bus.", command, GATEWAY_SILENCE_NS, settings)


def _recorder(config: UnitsConfig) -> str:
    command = tailor("record", "--quiet", "--max-duration", str(FILE_S), *_bus_flags(config))
    settings = [
        ("WorkingDirectory", path(config.record)),
        ("ReadWritePaths", path_in_list(config.record)),
        ("OOMScoreAdjust", "500"),
        ("PrivateDevices", "yes"),
        *unit_settings.network(config.bus.endpoint),
    ]
    return _unit(config, "recorder", "Records every message.", command, RECORDER_SILENCE_NS, settings)


def _driver(config: UnitsConfig) -> str:
    settings = [("LimitRTPRIO", str(realtime.DRIVER_PRIORITY)), ("OOMScoreAdjust", "-900")]
    if config.driver_command:  # it may need devices and the robot's network, and need not report to systemd
        return _unit(config, "driver", "Driver of the robot.", config.driver_command, None, settings)
    settings += [("PrivateDevices", "yes"), *unit_settings.network(config.bus.endpoint)]
    command = tailor("sim", config.robot, *_scenario(config), *_bus_flags(config))
    return _unit(config, "driver", "Simulated robot.", command, SIM_SILENCE_NS, settings)


def _executive(config: UnitsConfig) -> str:
    own_driver = ("--driver", config.driver_file) if config.driver_file else ()
    zoo = ("--zoo", config.zoo) if config.zoo else ()
    command = tailor("executive", config.domain, "--wait", *_scenario(config), *zoo, *own_driver, *_bus_flags(config))
    settings = [
        ("LimitRTPRIO", str(realtime.PRIORITY)),
        ("LimitMEMLOCK", "infinity"),
        ("OOMScoreAdjust", "-500"),
        ("PrivateDevices", "yes"),
        *unit_settings.network(config.bus.endpoint),
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


def _bus_flags(config: UnitsConfig) -> tuple[str, ...]:
    """Flags of every command; they override the file, whose relative paths mean another folder for a service."""
    file = ("--config", config.deployment_file) if config.deployment_file else ()
    key = ("--key", config.bus.key) if config.bus.key else ()
    ros = ("--profile", config.bus.profile, "--ros-domain", str(config.bus.ros_domain))
    return (*file, "--connect", config.bus.endpoint, *key, *(ros if config.bus.key_profile != PLAIN else ()))


def _scenario(config: UnitsConfig) -> tuple[str, ...]:
    return ("--scenario", config.scenario) if config.scenario else ()


def _name(part: str) -> str:
    return f"tailor-{part}.service"
