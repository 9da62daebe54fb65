"""Opens sessions of the bus: the router of a machine, a gateway for other sessions, and clients."""

from __future__ import annotations

import socket
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager, suppress
from functools import cache

from tailor.runtime.bus import zenoh_config
from tailor.runtime.bus.rights.credentials import Identity, Password, UnfitKeyError
from tailor.runtime.bus.rights.hosted_folder import hosted
from tailor.runtime.bus.rights.key_faults import check_files, out_of_date
from tailor.runtime.bus.rights.router_faults import fault_of_router
from tailor.runtime.bus.rights.run_folder import GATEWAY, SOCKET, RunFolder, run_folder
from tailor.runtime.bus.session import CannotOpenError, Session, opened
from tailor.runtime.descriptors import CLIENT, ROUTER, require_descriptors
from tailor.runtime.realtime import elevate_bus_threads, inherited_fifo
from tailor.schemas.errors import UnreachableError, UsageError
from tailor.schemas.ros2.profiles import PLAIN, KeyProfile
from tailor.schemas.services import ROLES, Role

SELF_CONNECT_MS = 500
PROBE_S = 0.5
_require = cache(require_descriptors)  # once: zenoh keeps what it has for the next session


@contextmanager
def open_router(listen: str = zenoh_config.DEFAULT_ENDPOINT) -> Iterator[Session]:
    """Router of an open bus at one endpoint, without local socket, passwords and rules; also a session like a client's.

    Raises:
      UsageError: The port is in use, or cannot be listened at, or this process may open too few files.
    """
    with ExitStack() as stack:
        with inherited_fifo():
            session = stack.enter_context(_router(zenoh_config.router(listen), listen))
            _start_threads(zenoh_config.client([listen], SELF_CONNECT_MS))
        yield session


@contextmanager
def open_local_router(
    endpoint: str, secured: bool = True, keys: KeyProfile = PLAIN
) -> Iterator[tuple[Session, RunFolder]]:
    """Router of this machine's processes; `open_gateway` listens at the endpoint itself, for all others.

    Args:
      endpoint: Names the bus; the local socket is in its run folder.
      secured: Demand the passwords of this run, and apply the access rules.
      keys: Key profile of this session and of all that connect to the local socket.

    Raises:
      UsageError: The bus runs already, or its folder cannot be made.
    """
    users = (*ROLES, GATEWAY) if secured else ()
    with ExitStack() as stack:
        folder = stack.enter_context(hosted(endpoint, users, keys))
        with inherited_fifo():
            session = stack.enter_context(_router(zenoh_config.local_router(folder), endpoint, keys))
            (folder.path / SOCKET).chmod(0o660)  # the folder decides who reaches it
            _start_threads(_local_client(folder, "observer", SELF_CONNECT_MS))
        yield session, folder


@contextmanager
def open_gateway(
    listen: str,
    folder: RunFolder,
    identity: Identity | None = None,
    names: Mapping[str, Role] | None = None,
    roles: Sequence[Role] = ROLES,
) -> Iterator[Session]:
    """Router for other sessions, linked to the local router of `folder`; see `zenoh_config.gateway`.

    Raises:
      UsageError: The port is in use, cannot be listened at, or there is no local router.
    """
    with _router(zenoh_config.gateway(listen, folder, identity, names or {}, roles), listen) as session:
        yield session


@contextmanager
def open_client(
    connect: str = zenoh_config.DEFAULT_ENDPOINT,
    timeout_s: float = 3.0,
    sender: str = "",
    role: Role = "observer",
    identity: Identity | None = None,
    keys: KeyProfile = PLAIN,
) -> Iterator[Session]:
    """Session with the bus at the endpoint `connect`; through its local socket if it runs on this machine.

    Args:
      connect: Endpoint that names the bus.
      timeout_s: Time limit for the connection.
      sender: Id of the session on the bus, 32 hex digits; empty: random.
      role: Decides what the session may publish, call and serve on a secured bus.
      identity: Certificate for a TLS endpoint, whose name decides instead of `role`.
      keys: Key profile of a bus on another machine; on this machine the bus decides.

    Raises:
      UnreachableError: No router responds within `timeout_s`, or the one of this machine hangs.
      UsageError: The router refuses this user, or this process may open too few files.
    """
    zenoh_config.check_endpoint(connect)
    _require(CLIENT)
    folder, timeout_ms = run_folder(connect), int(timeout_s * 1000)
    local = identity is None and folder.running()
    if local:
        config, keys = _local_client(folder, role, timeout_ms), folder.key_profile()
    else:
        config = zenoh_config.client([connect], timeout_ms, identity=identity)

    def explain(_: str) -> UsageError:  # a password that this user may read is that of the run
        return _no_response(connect, timeout_s) if local else _no_session(connect, identity)

    with _opened(config, explain, sender, keys, role) as session:
        yield session


def _local_client(folder: RunFolder, role: Role, timeout_ms: int) -> str:
    password = folder.password(role)
    credentials = None if password is None else Password(role, password)
    return zenoh_config.client([folder.socket_endpoint], timeout_ms, credentials)


def _router(config: str, listen: str, keys: KeyProfile = PLAIN) -> AbstractContextManager[Session]:
    def explain(cause: str) -> UsageError:
        reason = "the port is in use" if "in use" in cause else "cannot listen there"
        return UsageError(f"bus endpoint {listen}: {reason}; expected a free one, see --connect")

    _require(ROUTER)
    return _opened(config, explain, "", keys, "launcher")


@contextmanager
def _opened(
    config: str, explain: Callable[[str], UsageError], sender: str, keys: KeyProfile, node: str
) -> Iterator[Session]:
    with ExitStack() as stack:
        try:
            session = stack.enter_context(opened(config, sender, keys, node))
        except CannotOpenError as error:
            raise explain(str(error)) from error
        yield session


def _start_threads(client: str) -> None:
    """Connect: zenoh starts its serving threads with the first client. Those of an earlier bus are elevated too."""
    with suppress(CannotOpenError), opened(client):
        pass
    elevate_bus_threads()


def _no_response(endpoint: str, timeout_s: float) -> UsageError:
    return UnreachableError(
        f"bus endpoint {endpoint}: its router runs here, but does not respond within {timeout_s:g} s: "
        "it hangs or is stopped (Ctrl-Z); expected one that goes on"
    )


def _no_session(endpoint: str, identity: Identity | None) -> UsageError:
    host, _, port = endpoint.partition("/")[2].rpartition(":")
    try:
        socket.create_connection((host.strip("[]"), int(port)), PROBE_S).close()
    except OSError:
        return UnreachableError(f"bus endpoint {endpoint}: no router responds; start one with `tailor bus`")
    if identity is not None and (fault := _fault_of_key(identity)):
        return UnfitKeyError(fault)
    if identity is not None and (fault := fault_of_router(identity, host.strip("[]"), int(port), PROBE_S)):
        return UnfitKeyError(f"bus endpoint {endpoint}: it opens no session here: {fault}")
    why = "the bus belongs to another user, or this one has no key for it (`tailor keys`)"
    return UsageError(f"bus endpoint {endpoint}: it opens no session here: {why}")


def _fault_of_key(identity: Identity) -> str:
    try:
        check_files(identity)
    except UsageError as error:
        return str(error)
    return out_of_date(identity)
