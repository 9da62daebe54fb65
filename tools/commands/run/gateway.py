"""Let sessions of other users or machines onto the bus that runs on this machine, each with the rights of its role."""

from __future__ import annotations

import argparse
import os
import resource
import time
from contextlib import ExitStack

from tailor.runtime.bus.opening import open_gateway
from tailor.runtime.bus.rights.credentials import identity_in
from tailor.runtime.bus.rights.key_faults import check_files
from tailor.runtime.bus.rights.run_folder import run_folder
from tailor.runtime.malloc_settings import set_for_host
from tailor.runtime.processes.notify import Notifier
from tailor.runtime.stopping import Stop, stop_on_signals
from tailor.schemas.errors import UnreachableError, UsageError
from tailor.schemas.services import ROLES
from tailor.tools.cli.plain_text import note
from tailor.tools.cli.systems.bus_renewal import BusRenewal, BusRun, opened_anew
from tailor.tools.cli.systems.endpoint import bus_settings, configure_bus
from tailor.tools.keys.registry import ROUTER, registered_roles

PERIOD_S = 0.1
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
    stop = stop_on_signals()
    _set_process()

    def opened(sessions: ExitStack) -> BusRun:
        renewal = BusRenewal(arguments)  # first, as in `open_run`
        roles = registered_roles(arguments.keys) if arguments.keys else None  # each run has those of its beginning
        session = open_gateway(listen, folder, identity, roles, arguments.only or ROLES)
        return BusRun(sessions.enter_context(session), renewal)

    with ExitStack() as sessions:
        run: BusRun | None = opened(sessions)
        if not notifier.supervised:
            note(f"{listen} lets in {', '.join(arguments.only or ('every role',))}; Ctrl-C ends it")
        notifier.ready()
        while run is not None:
            _route(run, notifier, stop)
            run = opened_anew(sessions, opened, lambda: stop.requested)
            if run is not None:
                note(f"{listen} lets into the bus that was started anew")
        notifier.stopping()
    return 0


def _set_process() -> None:
    set_for_host()
    os.nice(NICENESS)
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))  # a port scan must not use them up


def _route(run: BusRun, notifier: Notifier, stop: Stop) -> None:
    """Route until a stop is requested, or another run of the bus has begun, which remote e-stops have to reach."""
    while not (stop.requested or run.due(time.monotonic_ns())):
        notifier.alive()
        time.sleep(PERIOD_S)
