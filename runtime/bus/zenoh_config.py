"""zenoh's configuration of a router and of a client: explicit endpoints, no discovery, loopback by default.

A deployed zenohd or rmw_zenohd accepts the same JSON. This module does not import zenoh.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tailor.runtime.bus.rights.credentials import Identity, Password
from tailor.runtime.bus.rights.run_folder import CERTIFICATE_USER, GATEWAY, RunFolder
from tailor.schemas.errors import UsageError
from tailor.schemas.packages.package_topics import PRIORITIES as TOPIC_PRIORITIES
from tailor.schemas.services import ROLES, Role

DEFAULT_ENDPOINT = "tcp/127.0.0.1:7447"
LEASE_MS = 1000  # a peer that is silent for longer counts as gone
QUEUE_SIZE = 16  # zenoh's 2 loses the tail of a burst under load
CONNECT_MS = 3000
RETRY_MS = 200  # zenoh's back-off reaches 4 s; data must be back within a second
MAX_PENDING = 2000  # connections that have sent nothing yet; zenoh's 100 let a port scan lock everyone out
ACCEPT_MS = 1000  # such a connection is closed then
# zenoh demands a password of every session of a router that has one for its own link; here the certificate decides.
BY_CERTIFICATE = Password(*CERTIFICATE_USER.split(":"))
# Of our topics, and of zenoh's own messages; the others keep zenoh's sizes.
PRIORITIES = ("control", *TOPIC_PRIORITIES)
# Allocated as a session opens: else each backlog takes further buffers of 64 kB, and memory grows for hours.
QUEUES = {"allocation": {"mode": "init"}, "size": dict.fromkeys(PRIORITIES, QUEUE_SIZE)}
# A message that may block, as those of replays and of ROS 2, made the router wait up to 5 s for each subscriber that
# reads nothing, and everybody else with it: e-stops came seconds late.
NEVER_BLOCK = {
    "id": "never block",
    "messages": ["put", "delete", "query"],
    "key_exprs": ["**"],
    "overwrite": {"congestion_control": "drop"},
    "flows": ["ingress"],
}
_LABEL = r"[A-Za-z0-9-]{1,63}"  # of a host's name; Python looks up no name with an empty or a longer one
_ENDPOINT = re.compile(rf"(tcp|tls|quic|udp|ws)/(\[[0-9a-fA-F:]{{2,45}}\]|({_LABEL}\.)*{_LABEL}\.?):([0-9]{{1,5}})")


def check_endpoint(endpoint: str) -> str:
    """The endpoint itself.

    Raises:
      UsageError: The endpoint does not have the form PROTOCOL/HOST:PORT.
    """
    match = _ENDPOINT.fullmatch(endpoint)
    if not match or not 0 < int(match[4]) < 65536:
        raise UsageError(f"bus endpoint {endpoint!r}: expected PROTOCOL/HOST:PORT, e.g. {DEFAULT_ENDPOINT}")
    return endpoint


def _base(mode: str) -> dict[str, Any]:
    return {
        "mode": mode,
        "scouting": {"multicast": {"enabled": False}, "gossip": {"enabled": False}},
        "transport": {
            # Shared memory would bypass the limits on message size.
            "shared_memory": {"enabled": False},
            "link": {"tx": {"lease": LEASE_MS, "queue": QUEUES}},
        },
    }


def router(listen: str) -> str:
    """JSON of an open router that listens at one endpoint and connects to none; a port in use is an error at once."""
    config = _listening(check_endpoint(listen))
    return json.dumps(config | {"connect": {"endpoints": []}})


def local_router(folder: RunFolder) -> str:
    """JSON of the router of one machine: it listens at the socket of a run folder alone, secured if that has users."""
    config = _listening(folder.socket_endpoint, local=True) | {"connect": {"endpoints": []}}
    if folder.secured:
        subjects = [{"id": name, "usernames": [name]} for name in (*ROLES, GATEWAY)]
        config |= _secured(subjects)
        config["transport"]["auth"] = {"usrpwd": {"dictionary_file": str(folder.users_file)}}
    return json.dumps(config)


def gateway(
    listen: str,
    folder: RunFolder,
    identity: Identity | None,
    names: Mapping[str, str],
    roles: Sequence[Role] = ROLES,
) -> str:
    """JSON of a router that listens for other sessions and passes what they may publish on to the local router.

    Args:
      listen: Its endpoint.
      folder: Of the local router.
      identity: Certificate of a TLS endpoint; None: passwords as the local router, if it has any.
      names: Role of each certificate's common name, for a TLS endpoint.
      roles: Sessions of other roles may do nothing here.
    """
    config = _listening(check_endpoint(listen))
    config["connect"] = _connecting([folder.socket_endpoint], CONNECT_MS)
    password = folder.password(GATEWAY)
    if password is not None:
        own = Password(GATEWAY, password)
        config["transport"]["auth"] = own.auth(folder.users_file if identity is None else folder.certificate_users_file)
        inwards = {"id": GATEWAY, "link_protocols": ["unixsock-stream"]}
        config |= _secured([*_subjects(names, identity, roles), inwards])
    if identity is not None:
        config["transport"]["link"]["tls"] = identity.listening()
    return json.dumps(config)


def _subjects(names: Mapping[str, str], identity: Identity | None, roles: Sequence[Role]) -> list[dict[str, Any]]:
    if identity is None:
        return [{"id": role, "usernames": [role]} for role in roles]
    common = {role: sorted(name for name, each in names.items() if each == role) for role in roles}
    return [{"id": role, "cert_common_names": found} for role, found in common.items() if found]


def client(
    connect: Sequence[str],
    timeout_ms: int = CONNECT_MS,
    password: Password | None = None,
    identity: Identity | None = None,
) -> str:
    """JSON of a client of the router at one of the endpoints; it does not listen, and reconnects after a restart."""
    config = _base("client") | {"connect": _connecting(connect, timeout_ms), "listen": {"endpoints": []}}
    if password is not None:
        config["transport"]["auth"] = password.auth()
    if identity is not None:
        config["transport"]["link"]["tls"] = identity.connecting()
        config["transport"]["auth"] = BY_CERTIFICATE.auth()
    return json.dumps(config)


def foreign_client(connect: str, folder: Path) -> str:
    """JSON for a node that is not ours, e.g. a ROS 2 bridge: the key of the folder is inside, so one file is enough."""
    config = _base("client") | {"connect": _connecting([check_endpoint(connect)], CONNECT_MS)}
    config["transport"]["link"]["tls"] = Identity(folder).embedded()
    config["transport"]["auth"] = BY_CERTIFICATE.auth()
    return json.dumps(config | {"listen": {"endpoints": []}}, indent=2)


def _listening(endpoint: str, local: bool = False) -> dict[str, Any]:
    from tailor.runtime.bus.rights import access  # which no client needs: a fifth of the start of an e-stop

    config = _base("router")
    config["downsampling"] = access.rate_limits(access.LOCAL_LIMIT_HZ if local else access.PEER_LIMIT_HZ)
    config["listen"] = {"endpoints": [endpoint], "timeout_ms": 0, "exit_on_failure": True}
    config["qos"] = {"network": [NEVER_BLOCK]}
    config["transport"]["unicast"] = {"accept_pending": MAX_PENDING, "accept_timeout": ACCEPT_MS}
    return config


def _connecting(endpoints: Sequence[str], timeout_ms: int) -> dict[str, Any]:
    return {
        "endpoints": list(endpoints),
        "timeout_ms": timeout_ms,
        "exit_on_failure": True,
        "retry": {"period_init_ms": RETRY_MS, "period_max_ms": RETRY_MS, "period_increase_factor": 1},
    }


def _secured(subjects: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    from tailor.runtime.bus.rights import access

    return {"access_control": access.access_control(subjects), "low_pass_filter": access.size_limits()}
