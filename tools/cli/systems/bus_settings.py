"""The table `[bus]` of a deployment file: where the bus listens, and for whom; and the flags that override it."""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace
from typing import Literal, get_args

from tailor.runtime.bus.zenoh_config import DEFAULT_ENDPOINT
from tailor.schemas.errors import UsageError
from tailor.schemas.ros2.profiles import MAX_DOMAIN, KeyProfile, Profile

REMOTE_ENDPOINT = "tls/0.0.0.0:7448"
KEYS = "tailor-keys"
Security = Literal["run", "local", "open"]


@dataclass(frozen=True, slots=True)
class BusSettings:
    """Endpoint that names the bus, and who may use it."""

    endpoint: str = DEFAULT_ENDPOINT  # the router listens there, all other processes connect to it
    # run: whoever reads the passwords of this run; local: the same, but no port is opened; open: everybody
    security: Security = "run"
    remote: str = ""  # second endpoint, for other machines: mutual TLS; empty: none
    keys: str = KEYS  # of `remote`: folder that `tailor keys` writes
    key: str = ""  # of this process for a bus on another machine: a folder in there
    # plain: <robot>/<topic>; rmw_zenoh: the keys of ROS 2 nodes under it; both: both at once
    profile: Profile = "plain"
    ros_domain: int = 0  # ROS_DOMAIN_ID, part of rmw_zenoh's keys

    def __post_init__(self) -> None:
        if not 0 <= self.ros_domain <= MAX_DOMAIN:
            raise UsageError(f"ros_domain is {self.ros_domain}, expected 0 to {MAX_DOMAIN}")

    @property
    def key_profile(self) -> KeyProfile:
        """Key profile of the bus."""
        return KeyProfile(self.profile, self.ros_domain)


def configure_hosting(parser: argparse.ArgumentParser) -> None:
    """Flags of the commands that host a bus."""
    parser.add_argument(
        "--secure",
        metavar="ENDPOINT",
        nargs="?",
        const=REMOTE_ENDPOINT,
        help=f"listen for other machines as well, with mutual TLS (default {REMOTE_ENDPOINT}); see `tailor keys`",
    )
    parser.add_argument("--keys", metavar="DIR", help=f"folder of the keys for --secure (default {KEYS})")
    parser.add_argument(
        "--security",
        choices=get_args(Security),
        help="who may use the bus: processes of this user, by passwords of this run (run, the default); the same "
        "without opening a port (local); everybody (open)",
    )


def with_hosting_flags(settings: BusSettings, arguments: argparse.Namespace) -> BusSettings:
    """Settings overridden by the flags of `configure_hosting`.

    Raises:
      UsageError: Keys are named, and the bus would let in nobody who has one.
    """
    given = {"remote": arguments.secure, "keys": arguments.keys, "security": arguments.security}
    merged = replace(settings, **{name: value for name, value in given.items() if value is not None})
    if arguments.keys is not None and not merged.remote:
        raise UsageError(f"--keys {arguments.keys}: expected with --secure, which lets other machines in by them")
    return merged
