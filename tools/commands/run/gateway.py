"""Let sessions of other users or machines onto the bus that runs on this machine, each with the rights of its role."""

from __future__ import annotations

import argparse
import os
import resource
import time

from tailor.runtime.bus.opening import open_gateway
from tailor.runtime.bus.rights.credentials import identity_in
from tailor.runtime.bus.rights.key_faults import check_files
from tailor.runtime.bus.rights.run_folder import run_folder
from tailor.runtime.malloc_settings import set_for_host
from tailor.runtime.processes.notify import Notifier
from tailor.runtime.stopping import stop_on_signals
from tailor.schemas.errors import UnreachableError, UsageError
from tailor.schemas.services import ROLES
from tailor.tools.cli.plain_text import note
from tailor.tools.cli.systems.endpoint import bus_settings, configure_bus
from tailor.tools.keys.registry import ROUTER, registered_roles

NICENESS = 5  # whoever floods it from outside competes with the robot's processes for the CPU


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor gateway`; `tailor up` and `tailor bus` start one by themselves."""
    parser.add_argument(
        "--listen", metavar="ENDPOINT", help="where to listen (default: the endpoint of the bus, with its passwords)"
    )
    parser.add_argument("--keys", metavar="DIR", help="folder that `tailor keys` wrote, for an endpoint tls/HOST:PORT")
    parser.add_argument(
        "--only", choices=ROLES, action="append", metavar="ROLE", help="let only this role in, e.g. people; repeatable"
    )
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Route until stopped."""
    notifier = Notifier.from_environment()
    endpoint = bus_settings(arguments).endpoint
    listen = arguments.listen or endpoint
    if listen.startswith("tls/") != bool(arguments.keys):
        raise UsageError(f"--listen {listen}: expected --keys with tls/HOST:PORT, and with nothing else")
    folder = run_folder(endpoint)
    if not folder.running():
        raise UnreachableError(f"bus endpoint {endpoint}: no router runs on this machine; start one with `tailor bus`")
    identity = identity_in(f"{arguments.keys}/{ROUTER}") if arguments.keys else None
    if identity is not None:
        check_files(identity)
    roles = registered_roles(arguments.keys) if arguments.keys else None
    stop = stop_on_signals()
    set_for_host()
    os.nice(NICENESS)
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))  # a port scan must not use them up
    with open_gateway(listen, folder, identity, roles, arguments.only or ROLES):
        if not notifier.supervised:
            note(f"{listen} lets in {', '.join(arguments.only or ('every role',))}; Ctrl-C ends it")
        notifier.ready()
        while not stop.requested:
            notifier.alive()
            time.sleep(0.1)
        notifier.stopping()
    return 0
