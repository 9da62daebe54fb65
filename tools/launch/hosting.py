"""Hosts a bus: the router of this machine's processes in this process, and a child for each endpoint of others."""

from __future__ import annotations

import errno
import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from tailor.runtime.bus.opening import open_local_router
from tailor.runtime.bus.rights.credentials import identity_in
from tailor.runtime.bus.rights.key_faults import check_files, out_of_date
from tailor.runtime.bus.rights.run_folder import run_folder
from tailor.runtime.bus.session import Session
from tailor.runtime.bus.zenoh_config import check_endpoint
from tailor.runtime.descriptors import require_descriptors
from tailor.runtime.processes.child import tailor
from tailor.runtime.processes.supervised import ProcessSpec
from tailor.schemas.errors import UsageError
from tailor.tools.cli.systems.bus_settings import BusSettings
from tailor.tools.keys.registry import ROUTER, registered_roles

BY_CERTIFICATES = ("tls/", "quic/")  # protocols that need keys
HOST_DESCRIPTORS, DESCRIPTORS_EACH = 23, 2  # measured: of the router and of starting a process; of each that runs
MAX_PORTS = 1000  # that are tried for one which names no bus
GATEWAY_SILENCE_NS = 5_000_000_000  # of its main loop; floods keep only zenoh's threads busy


@contextmanager
def hosted_bus(settings: BusSettings, report: Callable[[str], None], processes: int = 0) -> Iterator[Session]:
    """The router's own session; start `gateways` beside it, and as many other `processes` as are to run here.

    Raises:
      UsageError: The bus runs already, an endpoint is in use, malformed or of no use there, the keys for other machines
        are missing, or this process may open too few files.
    """
    _check(settings)
    require_descriptors(HOST_DESCRIPTORS + DESCRIPTORS_EACH * (len(gateways(settings)) + processes))
    if settings.remote and (fault := out_of_date(identity_in(f"{settings.keys}/{ROUTER}"))):
        report(f"{fault}: no other machine opens a session")
    if settings.security == "open":
        report(f"the bus is open: whoever reaches {settings.endpoint} drives the robot")
    secured, keys = settings.security != "open", settings.key_profile
    with open_local_router(settings.endpoint, secured, keys) as (session, _):
        yield session


def gateways(settings: BusSettings) -> list[ProcessSpec]:
    """Processes that let others in; apart from the router, so that floods and port scans end there."""
    name = ("--connect", settings.endpoint)
    specs = []
    if settings.endpoint in _endpoints(settings):
        specs.append(ProcessSpec("gateway", tailor("gateway", *name), silence_ns=GATEWAY_SILENCE_NS))
    if settings.remote:
        remote = ("--listen", settings.remote, "--keys", settings.keys)
        specs.append(ProcessSpec("remote gateway", tailor("gateway", *name, *remote), silence_ns=GATEWAY_SILENCE_NS))
    return specs


def check_own_endpoint(settings: BusSettings) -> None:
    """Raise UsageError if a bus cannot listen by passwords at the endpoint that names it."""
    if settings.security != "local" and settings.endpoint.startswith(BY_CERTIFICATES):
        raise UsageError(
            f"bus endpoint {settings.endpoint}: who connects there has a password, expected tcp/HOST:PORT; "
            "--secure tls/HOST:PORT lets other machines in by keys"
        )


def _check(settings: BusSettings) -> None:
    """Refuse here what a gateway would end by, beside a robot that drives already."""
    check_own_endpoint(settings)
    if settings.key:
        raise UsageError(f"key {settings.key}: of a bus on another machine, expected none where the bus itself runs")
    for endpoint in _endpoints(settings):
        _check_free(endpoint)
    if settings.remote and not settings.remote.startswith("tls/"):
        raise UsageError(f"bus endpoint {settings.remote}: expected tls/HOST:PORT for other machines")
    if settings.remote and settings.security == "open":
        raise UsageError(f"bus endpoint {settings.remote}: expected a secured bus for other machines, not an open one")
    if settings.remote:
        check_files(identity_in(f"{settings.keys}/{ROUTER}"))
        registered_roles(settings.keys)


def _endpoints(settings: BusSettings) -> list[str]:
    """Where others can reach the bus."""
    own = [settings.endpoint] if settings.security != "local" else []
    return own + ([settings.remote] if settings.remote else [])


def free_endpoint() -> str:
    """Unused loopback endpoint, for a system that must not meet another one.

    A secured bus without an open port has a folder alone, and one that was killed leaves it: neither name is free.

    Raises:
      UsageError: None of many ports is free.
    """
    for _ in range(MAX_PORTS):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            endpoint = f"tcp/127.0.0.1:{probe.getsockname()[1]}"
        if not run_folder(endpoint).path.exists():
            return endpoint
    folder = run_folder(endpoint).path.parent
    raise UsageError(
        f"{folder}: has a bus for each of {MAX_PORTS} free ports, expected few; remove those that were killed"
    )


def private_bus() -> BusSettings:
    """A bus for one system alone, without an open port."""
    return BusSettings(free_endpoint(), security="local")


def _check_free(endpoint: str) -> None:
    """Refuse a port that cannot be listened at, before any process starts."""
    protocol, _, address = check_endpoint(endpoint).partition("/")
    host, _, port = address.rpartition(":")
    family = socket.AF_INET6 if host.startswith("[") else socket.AF_INET
    with socket.socket(family, socket.SOCK_DGRAM if protocol in ("udp", "quic") else socket.SOCK_STREAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((host.strip("[]"), int(port)))
        except OSError as error:
            reason = (
                "the port is in use" if error.errno == errno.EADDRINUSE else f"cannot listen there ({error.strerror})"
            )
            raise UsageError(f"bus endpoint {endpoint}: {reason}; expected a free one, see --connect") from error
