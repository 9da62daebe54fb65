"""zenoh's configuration of a router and of a client: explicit endpoints, no discovery, loopback by default.

A deployed zenohd or rmw_zenohd accepts the same JSON. This module does not import zenoh.
"""

from __future__ import annotations

import json
import re
from typing import Any

from tailor.schemas.errors import UsageError
from tailor.schemas.messages import ArmRequest, EStop
from tailor.schemas.topics import TOPICS

DEFAULT_ENDPOINT = "tcp/127.0.0.1:7447"
LEASE_MS = 1000  # a peer that is silent for longer counts as gone
QUEUE_SIZE = 16  # zenoh's 2 loses the tail of a burst under load
CONNECT_MS = 3000
RETRY_MS = 200  # zenoh's back-off reaches 4 s; data must be back within a second
MAX_PENDING = 2000  # connections that have sent nothing yet; zenoh's 100 let a port scan lock everyone out
ACCEPT_MS = 1000  # such a connection is closed then
REQUEST_LIMIT_HZ = 1000.0  # a flood brings 50 000; a release and a stop 1 ms apart both pass
PRIORITIES = (
    "control",
    "real_time",
    "interactive_high",
    "interactive_low",
    "data_high",
    "data",
    "data_low",
    "background",
)
_ENDPOINT = re.compile(r"(tcp|tls|quic|udp|ws)/(\[[0-9a-fA-F:]+\]|[A-Za-z0-9.-]+):([0-9]{1,5})")


def check_endpoint(endpoint: str) -> str:
    """The endpoint itself.

    Raises:
      UsageError: The endpoint does not have the form PROTOCOL/HOST:PORT.
    """
    match = _ENDPOINT.fullmatch(endpoint)
    if not match or not 0 < int(match[3]) < 65536:
        raise UsageError(f"bus endpoint {endpoint!r}: expected PROTOCOL/HOST:PORT, e.g. {DEFAULT_ENDPOINT}")
    return endpoint


def _base(mode: str) -> dict[str, Any]:
    return {
        "mode": mode,
        "scouting": {"multicast": {"enabled": False}, "gossip": {"enabled": False}},
        "transport": {
            # Shared memory would bypass the limits on message size.
            "shared_memory": {"enabled": False},
            "link": {"tx": {"lease": LEASE_MS, "queue": {"size": dict.fromkeys(PRIORITIES, QUEUE_SIZE)}}},
        },
    }


def _rate_limits() -> dict[str, Any]:
    """Rate limits for each peer on the keys of e-stops and arming; the router drops what exceeds them.

    Commands have none: of two in quick succession the newer one would be dropped.
    """
    topics = [topic for topic in TOPICS.values() if topic.type in (EStop, ArmRequest)]
    rules = [{"key_expr": topic.key.format(robot="*"), "freq": REQUEST_LIMIT_HZ} for topic in topics]
    return {"id": "floods", "messages": ["put", "delete"], "flows": ["ingress"], "rules": rules}


def router(listen: str) -> str:
    """JSON of a router that listens at one endpoint and connects to none; a port in use is an error at once."""
    listening = {"endpoints": [check_endpoint(listen)], "timeout_ms": 0, "exit_on_failure": True}
    config = _base("router") | {"downsampling": [_rate_limits()]}
    config["transport"]["unicast"] = {"accept_pending": MAX_PENDING, "accept_timeout": ACCEPT_MS}
    return json.dumps(config | {"listen": listening, "connect": {"endpoints": []}})


def client(connect: str, timeout_ms: int = CONNECT_MS) -> str:
    """JSON of a client of the router at `connect`; it does not listen, and reconnects to a router that restarts."""
    connecting = {
        "endpoints": [check_endpoint(connect)],
        "timeout_ms": timeout_ms,
        "exit_on_failure": True,
        "retry": {"period_init_ms": RETRY_MS, "period_max_ms": RETRY_MS, "period_increase_factor": 1},
    }
    return json.dumps(_base("client") | {"connect": connecting, "listen": {"endpoints": []}})
