"""The hardware behind `tailor driver` and `tailor up --hardware`, as people name it."""

from __future__ import annotations

from collections.abc import Iterable

from tailor.runtime.bus.rights.credentials import identity_in
from tailor.runtime.bus.rights.run_folder import run_folder
from tailor.runtime.bus.zenoh_config import check_endpoint
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import robot_names
from tailor.simnodes.driver_spec import shipped_driver_spec
from tailor.simnodes.hardware.interface import Hardware
from tailor.simnodes.hardware.loading import load_hardware
from tailor.simnodes.hardware.plain_robot import PlainRobot
from tailor.simnodes.hardware.plain_settings import PlainSettings, read_plain_settings

PLAIN_SENSORS = ("odom", "pose")


def hardware_of(named: str, endpoint: str) -> Hardware:
    """The hardware that a person names; nothing is opened.

    Args:
      named: FILE.toml of a robot with plain topics, or MODULE:CLASS.
      endpoint: Tailor's bus.

    Raises:
      UsageError: There is no such hardware, plain topics cannot drive it, or they cannot be on the bus that is to
        carry them.
    """
    if not named.endswith(".toml"):
        return load_hardware(named)
    settings = read_plain_settings(named)
    _check_commands(named, settings.robot)
    _check_bus(named, settings, endpoint)
    return PlainRobot(settings, endpoint)


def check_sensors(named: str, required: Iterable[str]) -> None:
    """Raise UsageError if a domain requires sensors that plain topics do not carry: the executive would hold for ever.

    Args:
      named: FILE.toml of a robot with plain topics, or MODULE:CLASS, which may measure anything.
      required: Those of the domain.
    """
    lacking = [name for name in required if name not in PLAIN_SENSORS]
    if named.endswith(".toml") and lacking:
        raise UsageError(
            f"{named}: the domain requires {', '.join(lacking)}, but plain topics carry "
            f"{' and '.join(PLAIN_SENSORS)} alone; expected MODULE:CLASS of a Hardware"
        )


def _check_commands(file: str, robot: str) -> None:
    """Raise UsageError if a robot obeys other commands: a twist would carry the speeds of its joints, or lack some.

    One that is not installed is refused by whoever knows which robot was expected.
    """
    commands = shipped_driver_spec(robot).command_topics if robot in robot_names() else ("cmd_vel",)
    if commands != ("cmd_vel",):
        raise UsageError(
            f"{file}: {robot} obeys {', '.join(commands)}, but plain topics carry cmd_vel alone; expected "
            "MODULE:CLASS of a Hardware"
        )


def _check_bus(file: str, settings: PlainSettings, endpoint: str) -> None:
    """Raise UsageError if the robot's topics cannot be on the bus that is to carry them, or it cannot be opened."""
    try:
        check_endpoint(settings.bus.connect or endpoint)
        if settings.bus.key:
            identity_in(settings.bus.key)
    except UsageError as error:
        raise UsageError(f"{file}: {error}") from error
    if settings.bus.connect not in ("", endpoint):
        return
    ours = {f"{settings.robot}/{name}" for name in ("cmd_vel", *PLAIN_SENSORS)}
    names = {name.strip("/") for name in (settings.topics.cmd_vel, settings.topics.odom, settings.topics.pose)}
    both = sorted(ours & names)
    if both and settings.bus.profile == "plain":
        raise UsageError(
            f"{file}: {', '.join(both)} is Tailor's own, past whose guard nothing may drive; expected other names on "
            "this bus, or bus.connect with a bus of the robot's own"
        )
    if run_folder(endpoint).secured:
        raise UsageError(
            f"{file}: the bus at {endpoint} lets only Tailor's processes publish; expected bus.connect with a bus of "
            "the robot's own, or `tailor bus --security open`"
        )
