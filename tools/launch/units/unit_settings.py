"""Settings of systemd that the services share: supervision, real time, and what a service cannot reach."""

from __future__ import annotations

from collections.abc import Iterator

from tailor.runtime.bus.rights.run_folder import VARIABLE
from tailor.runtime.processes.child import ONE_THREAD
from tailor.runtime.processes.restart import FIRST_DELAY_NS, MAX_STARTS, WINDOW_NS
from tailor.runtime.processes.supervised import STARTUP_NS

RUN_FOLDER = "tailor"  # in /run; made for the bus, read by the others
STOP_S = 5  # from SIGTERM to SIGKILL: the robot comes to rest, files are closed
BAD_INPUT = 2  # exit code; a restart does not correct it
LOCAL_HOSTS = ("127.", "localhost", "[::1]")

HARDENING = (
    ("NoNewPrivileges", "yes"),
    ("CapabilityBoundingSet", ""),
    ("ProtectSystem", "strict"),
    ("ProtectHome", "read-only"),  # the interpreter and the deployment file may lie there
    ("PrivateTmp", "yes"),
    ("ProtectProc", "invisible"),
    ("ProtectKernelTunables", "yes"),
    ("ProtectKernelModules", "yes"),
    ("ProtectKernelLogs", "yes"),
    ("ProtectControlGroups", "yes"),
    ("ProtectClock", "yes"),
    ("ProtectHostname", "yes"),
    ("LockPersonality", "yes"),
    ("RestrictNamespaces", "yes"),
    ("RestrictSUIDSGID", "yes"),
    ("RestrictAddressFamilies", "AF_UNIX AF_INET AF_INET6 AF_NETLINK"),  # netlink: zenoh lists the interfaces
    ("SystemCallArchitectures", "native"),
    ("SystemCallFilter", "@system-service"),
    ("SystemCallErrorNumber", "EPERM"),
    ("UMask", "0027"),
)


def restart_limits() -> tuple[tuple[str, str], ...]:
    """The launcher's limit of a crash loop, for the section Unit."""
    return (
        ("StartLimitIntervalSec", f"{WINDOW_NS // 1_000_000_000}"),
        ("StartLimitBurst", f"{MAX_STARTS}"),
    )


def supervision(silence_ns: int | None) -> Iterator[tuple[str, str]]:
    """Start, watchdog, restart and end of a service, as the launcher does it.

    Args:
      silence_ns: Limit between two reports of its loop; None: it reports nothing.
    """
    if silence_ns is None:
        yield "Type", "exec"
    else:
        yield "Type", "notify"
        yield "NotifyAccess", "main"
        yield "WatchdogSec", _seconds(silence_ns)
        yield "WatchdogSignal", "SIGKILL"
    yield "TimeoutStartSec", _seconds(STARTUP_NS)
    yield "Restart", "on-failure"
    yield "RestartSec", _seconds(FIRST_DELAY_NS)
    yield "RestartPreventExitStatus", str(BAD_INPUT)
    yield "KillMode", "mixed"  # SIGTERM to the process itself; SIGKILL to all that it has started
    yield "TimeoutStopSec", str(STOP_S)


def environment() -> tuple[tuple[str, str], ...]:
    """Environment of every service."""
    variables = {**ONE_THREAD, VARIABLE: f"/run/{RUN_FOLDER}"}
    return tuple(("Environment", f"{name}={value}") for name, value in variables.items())


def network(endpoint: str) -> tuple[tuple[str, str], ...]:
    """No packet leaves this machine if the bus is on it alone."""
    host = endpoint.partition("/")[2]
    return (("IPAddressDeny", "any"), ("IPAddressAllow", "localhost")) if host.startswith(LOCAL_HOSTS) else ()


def _seconds(nanoseconds: int) -> str:
    return f"{nanoseconds / 1e9:g}"
