"""Flags that select the bus, and the session that they open.

Loads no executive unless a deployment file is named: `tailor estop` must not wait for one.
"""

from __future__ import annotations

import argparse
import re
from contextlib import AbstractContextManager
from dataclasses import replace

from tailor.runtime.bus.opening import open_client
from tailor.runtime.bus.rights.credentials import identity_in
from tailor.runtime.bus.session import Session
from tailor.runtime.bus.zenoh_config import DEFAULT_ENDPOINT
from tailor.schemas.errors import UsageError
from tailor.schemas.ros2.profiles import PROFILES
from tailor.schemas.services import Role
from tailor.tools.cli.given_options import given_options
from tailor.tools.cli.systems.bus_settings import BusSettings


def configure_bus(parser: argparse.ArgumentParser) -> None:
    """Flags of every command that connects to the bus."""
    parser.add_argument("--connect", metavar="ENDPOINT", help=f"bus endpoint (default {DEFAULT_ENDPOINT})")
    parser.add_argument("--key", metavar="DIR", help="key for a bus on another machine, made by `tailor keys new`")
    parser.add_argument(
        "--profile",
        choices=PROFILES,
        help="keys on the bus: <robot>/<topic> (plain, the default), those of ROS 2 under rmw_zenoh, or both; where a "
        "bus runs on this machine, its own profile holds",
    )
    parser.add_argument("--ros-domain", metavar="N", type=int, help="ROS_DOMAIN_ID of rmw_zenoh's keys (default 0)")
    parser.add_argument("--config", metavar="FILE", default="", help="deployment file (TOML)")


def refuse_bus_flags(arguments: argparse.Namespace) -> None:
    """Raise UsageError if a flag of `configure_bus` was given to a command that connects with --live alone."""
    names = {f"--{name.replace('_', '-')}": name for name in ("connect", "key", "profile", "ros_domain", "config")}
    if given := given_options(configure_bus, arguments, names):
        raise UsageError(f"{', '.join(given)}: expected with --live, which alone connects to a bus")


def bus_settings(arguments: argparse.Namespace) -> BusSettings:
    """The bus that the flags select. The whole deployment file is checked, so that no mistake in it goes unnoticed.

    Raises:
      UsageError: See `tailor.tools.cli.systems.deployment.read_deployment`.
    """
    settings = BusSettings()
    if arguments.config:
        from tailor.tools.cli.systems.deployment import read_deployment

        settings = read_deployment(arguments.config).bus
    return with_bus_flags(settings, arguments)


def with_bus_flags(settings: BusSettings, arguments: argparse.Namespace) -> BusSettings:
    """Settings overridden by the flags of `configure_bus`."""
    flags = {"endpoint": "connect", "key": "key", "profile": "profile", "ros_domain": "ros_domain"}
    given = {name: vars(arguments).get(flag) for name, flag in flags.items()}
    return replace(settings, **{name: value for name, value in given.items() if value is not None})


def open_bus(arguments: argparse.Namespace, role: Role, sender: str = "") -> AbstractContextManager[Session]:
    """Session with the bus that the flags select.

    Args:
      arguments: Parsed flags.
      role: Decides what the session may do on a secured bus; with --key, the key's name decides.
      sender: Id of the session on the bus, 32 hex digits; empty: random.

    Raises:
      UsageError: Wrong flags, no router, or no access.
    """
    settings = bus_settings(arguments)
    identity = identity_in(settings.key) if settings.key else None
    return open_client(settings.endpoint, sender=sender, role=role, identity=identity, keys=settings.key_profile)


def key_advice(arguments: argparse.Namespace, does: str) -> str:
    """What else may be wrong where nobody has answered: another role is not told that it was not heard; or empty."""
    key = bus_settings(arguments).key
    return f"{key}: a key {does} only if its role is people (tailor keys list)" if key else ""


def configure_sender(parser: argparse.ArgumentParser) -> None:
    """The flag --sender: a launcher gives each of its children an id, by which it knows their messages."""
    parser.add_argument("--sender", metavar="HEX", default="", help="sender id, 32 hex digits (default: random)")


def sender_of(arguments: argparse.Namespace) -> str:
    """Sender id, or "" for a random one; raises UsageError for anything else."""
    return checked_sender(arguments.sender, "--sender")


def checked_sender(sender: str | None, flag: str) -> str:
    """Value of a flag that holds a sender id, "" without one; raises UsageError for anything else."""
    if sender and not re.fullmatch("[0-9a-f]{32}", sender):
        raise UsageError(f"{flag} {sender}: expected 32 hex digits")
    return sender or ""
