"""Write unit files of systemd for one robot: bus, driver, executive, recorder, and a target that groups them.

After every start of a service a person arms the robot and sends a goal. docs/deployment.md describes the installation.
"""

from __future__ import annotations

import argparse
import getpass
import os
import pwd
import re
import shlex
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from tailor.executive.composition import build_context
from tailor.runtime.bus.rights.credentials import identity_in
from tailor.runtime.bus.rights.key_faults import check_files
from tailor.runtime.bus.zenoh_config import check_endpoint
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import spec_of_robot
from tailor.tools.cli.output_files import whole_output
from tailor.tools.cli.systems.bus_settings import BusSettings, configure_hosting, with_hosting_flags
from tailor.tools.cli.systems.deployment import executive_config
from tailor.tools.cli.systems.endpoint import bus_settings, configure_bus
from tailor.tools.cli.systems.system_flags import deployment_from
from tailor.tools.keys.registry import ROUTER
from tailor.tools.launch.checks.driver_check import check_driver, driver_of
from tailor.tools.launch.hosting import check_own_endpoint
from tailor.tools.launch.units.unit_files import PARTS, UnitsConfig, unit_files

SYSTEMD = ("/etc/systemd", "/run/systemd", "/usr/lib/systemd", "/usr/local/lib/systemd")  # units that this machine runs
USER = re.compile(r"[a-z_][a-z0-9_-]{0,30}\$?")


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor units`."""
    add = parser.add_argument
    add("folder", metavar="DIR", type=Path, help="folder for the files, e.g. /etc/systemd/system; made if missing")
    add("--domain", default="soccer", help="domain to run (default soccer)")
    add("--scenario", help="scenario of the domain (default: its first)")
    add("--user", default="", help="user of the services (default: you, unless you are root)")
    add("--parts", metavar="LIST", default="", help=f"parts on this machine (default: {','.join(PARTS)})")
    add("--record", metavar="DIR", help="folder of the recordings; without it there is no recorder")
    add("--driver-command", metavar="COMMAND", default="", help="driver of the hardware, instead of the simulator")
    add("--driver", metavar="FILE", help="specification of that driver (default: that of the simulated robot)")
    add("--force", action="store_true", help="overwrite existing files")
    configure_hosting(parser)
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Check everything, then write all files, and print their names."""
    files = unit_files(_config(arguments))
    folder: Path = arguments.folder
    existing = [name for name in files if (folder / name).exists()]
    if existing and not arguments.force:
        raise UsageError(f"{folder}: has {', '.join(existing)} already, expected --force to overwrite")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"{error.filename or folder}: {error.strerror}, expected a writable folder") from error
    for name, text in files.items():
        with whole_output(folder / name) as whole:
            whole.write_text(text, encoding="utf-8")
        print(folder / name)
    return 0


def _config(arguments: argparse.Namespace) -> UnitsConfig:
    deployment = deployment_from(arguments)
    domain = build_context(executive_config(arguments.domain, deployment), sender="").domain
    check_driver(domain, driver_of(domain, arguments.driver))
    parts = _parts(arguments.parts, bool(arguments.record))
    if "driver" in parts and not arguments.driver_command and not spec_of_robot(domain.robot).body:
        raise UsageError(f"{domain.robot} has no simulated body, expected --driver-command with that of its hardware")
    return UnitsConfig(
        domain=arguments.domain,
        robot=domain.robot,
        user=_user(arguments.user, arguments.folder),
        bus=_bus(arguments, parts),
        parts=parts,
        deployment_file=_absolute(arguments.config) if arguments.config else "",
        scenario=arguments.scenario or "",
        zoo=_absolute(deployment.zoo) if deployment.zoo else "",
        record=_folder(arguments.record) if arguments.record else "",
        driver_command=_driver_command(arguments.driver_command),
        driver_file=_absolute(arguments.driver) if arguments.driver else "",
    )


def _bus(arguments: argparse.Namespace, parts: tuple[str, ...]) -> BusSettings:
    settings = with_hosting_flags(bus_settings(arguments), arguments)
    check_endpoint(settings.endpoint)
    if "bus" in parts:
        check_own_endpoint(settings)
    if settings.key and ("bus" in parts or len(parts) > 1):
        raise UsageError(f"--key {settings.key}: a key has one role, expected one part that connects, see --parts")
    key, keys = (_absolute(path) if path else "" for path in (settings.key, settings.keys))
    own = f"{keys}/{ROUTER}" if "bus" in parts and settings.remote else ""
    _check_keys([folder for folder in (key, own) if folder], arguments)
    return replace(settings, key=key, keys=keys)


def _check_keys(folders: Sequence[str], arguments: argparse.Namespace) -> None:
    """Keys that a service would end without; those that are not here may be on the machine that runs it."""
    for folder in folders:
        try:
            check_files(identity_in(folder))
        except UsageError as error:
            if _of_this_machine(arguments.folder):
                raise
            print(f"{error}; expected on the machine that runs these services", file=sys.stderr)


def _of_this_machine(folder: Path) -> bool:
    """Whether systemd reads units there; others are made for another machine, perhaps."""
    return any(folder.resolve().is_relative_to(each) for each in SYSTEMD)


def _absolute(path: str) -> str:
    return str(Path(path).resolve())


def _folder(path: str) -> str:
    if not Path(path).is_dir():
        raise UsageError(f"--record {path!r}: expected a folder that exists and that the services' user may write")
    return _absolute(path)


def _user(name: str, folder: Path) -> str:
    """The services' user; one that does not exist here may exist on the machine that the files are made for."""
    user = name or getpass.getuser()
    if user == "root" and not name:
        raise UsageError("--user is missing, expected the user of the services; they need no root")
    if not USER.fullmatch(user):
        raise UsageError(f"--user {user}: expected a user name")
    try:
        pwd.getpwnam(user)
    except KeyError:
        missing = f"--user {user}: no such user on this machine"
        if _of_this_machine(folder):
            raise UsageError(f"{missing}, expected one that exists (useradd --system {user})") from None
        print(f"{missing}; expected on the one that runs these services", file=sys.stderr)
    return user


def _parts(text: str, record: bool) -> tuple[str, ...]:
    named = tuple(part for part in text.split(",") if part)
    unknown = [part for part in named if part not in PARTS]
    if unknown:
        raise UsageError(f"--parts {text}: unknown {', '.join(unknown)}, expected some of: {', '.join(PARTS)}")
    if "recorder" in named and not record:
        raise UsageError("--parts with recorder, expected --record DIR as well")
    return named or tuple(part for part in PARTS if part != "recorder" or record)


def _driver_command(text: str) -> tuple[str, ...]:
    try:
        command = tuple(shlex.split(text))
    except ValueError as error:
        raise UsageError(f"--driver-command {text}: {error}") from error
    if command and not (os.path.isabs(command[0]) and os.access(command[0], os.X_OK)):
        none = ": there is no such program" if os.path.isabs(command[0]) else ""
        raise UsageError(f"--driver-command {command[0]}{none}: expected the absolute path of a program")
    return command
