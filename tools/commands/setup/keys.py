"""Make, list and revoke the keys with which processes on several machines prove who they are.

The machine of the bus keeps the folder with the authority and the router's key; each other machine gets the folder of
its own names alone: tailor-keys/NAME. `tailor up --secure` and `tailor bus --secure` read the roles at their start.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping
from pathlib import Path
from typing import get_args

from tailor.runtime.bus.zenoh_config import check_endpoint, foreign_client
from tailor.schemas.errors import UsageError
from tailor.schemas.services import Role
from tailor.tools.cli.output_folders import temporary_beside
from tailor.tools.cli.systems.bus_settings import KEYS
from tailor.tools.keys.registry import (
    REVOKED,
    ROUTER,
    check_host,
    check_name,
    check_unused,
    only_writer,
    registered_roles,
    write_role,
)

DAYS = 825  # two years and a quarter, as many clients accept at most
MAX_DAYS = 9999
SESSION = "session.json5"

EPILOG = """\
roles:
  executive, driver, recorder, scene   publish what the Tailor process of that name does
  player                               publishes what tailor replay does
  people                               arm, stop and send goals
  observer                             publishes nothing: status, view

examples:
  tailor keys new router --host robot.local --host 10.0.0.5      (first, on the machine of the bus: its names)
  tailor keys new operator --role people                         (then copy the folder tailor-keys/operator)
  tailor estop --connect tls/robot.local:7448 --key operator     (on the other machine)
  tailor keys new bridge --role driver --for tls/robot.local:7448
  tailor keys list
  tailor keys revoke operator

docs/security.md lists what each role may publish."""
VERBS = "new: make a key; list: names and their roles; revoke: take a name's rights at the next start of the bus"


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor keys`."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    parser.add_argument("action", choices=("new", "list", "revoke"), help=VERBS)
    parser.add_argument("name", nargs="?", default="", help="name of a process, e.g. agilo-driver")
    parser.add_argument("--role", choices=get_args(Role), help="what it may do; not for the name 'router'")
    parser.add_argument(
        "--host", action="append", default=[], help="name or address at which others reach the router; repeatable"
    )
    parser.add_argument(
        "--for",
        dest="endpoint",
        metavar="ENDPOINT",
        help=f"tls/HOST:PORT: also write {SESSION}, zenoh's configuration for a foreign node, e.g. a ROS 2 bridge",
    )
    parser.add_argument("--days", type=int, default=DAYS, help="days for which the key is valid (default %(default)s)")
    parser.add_argument("--keys", metavar="DIR", default=KEYS, help="folder of the keys (default %(default)s)")
    parser.add_argument(
        "--json", action="store_true", help="print the roles, the new folder or the revoked name as JSON"
    )


def run(arguments: argparse.Namespace) -> int:
    """0 if done."""
    _check_flags(arguments)
    if arguments.action == "list":
        roles = registered_roles(arguments.keys)
        lines = "\n".join(f"{name}: {role}" for name, role in sorted(roles.items()))
        _report(arguments, lines or f"{arguments.keys}: no keys", roles)
    elif arguments.action == "revoke":
        _revoke(arguments)
    else:
        _new(arguments)
    return 0


def _check_flags(arguments: argparse.Namespace) -> None:
    """Raise UsageError for what only another action takes: it would be ignored."""
    action = arguments.action
    given = {
        "--role": arguments.role,
        "--host": arguments.host,
        "--for": arguments.endpoint,
        "--days": arguments.days != DAYS,
        "NAME": action == "list" and arguments.name,
    }
    if action != "new" and (wrong := [flag for flag, value in given.items() if value]):
        raise UsageError(f"{', '.join(wrong)}: not of `tailor keys {action}`")


def _new(arguments: argparse.Namespace) -> None:
    name = check_name(arguments.name)
    if (name == ROUTER) == bool(arguments.role):
        raise UsageError(f"--role: expected one for every name, but none for '{ROUTER}'")
    if name == ROUTER and not arguments.host:
        raise UsageError("--host is missing, expected the names or addresses at which the others reach the router")
    if arguments.endpoint and not check_endpoint(arguments.endpoint).startswith("tls/"):
        raise UsageError(f"--for {arguments.endpoint}: a key opens no session there, expected tls/HOST:PORT")
    for host in arguments.host:
        check_host(host)
    if not 0 < arguments.days <= MAX_DAYS:
        raise UsageError(f"--days is {arguments.days}, expected 1 to {MAX_DAYS}")
    folder = Path(arguments.keys) / name
    try:
        with only_writer(arguments.keys):
            check_unused(arguments.keys, name)
            _issue(arguments, folder)
    except OSError as error:
        raise UsageError(f"{error.filename or folder}: {error.strerror}, expected a place for keys") from error
    _report(arguments, str(folder), {"folder": str(folder)})


def _issue(arguments: argparse.Namespace, folder: Path) -> None:
    from tailor.tools.keys.authority import Authority, utc_now

    name, now = arguments.name, utc_now()
    if folder.exists():
        other = "a new name" if name != ROUTER else "one folder for it: remove that to make it anew, for more hosts say"
        raise UsageError(f"{folder}: exists already, expected {other}")
    authority = Authority.of(folder.parent, now, MAX_DAYS)  # --days is not for it: no key outlasts what signed it
    with temporary_beside(folder) as beside:
        unfinished = beside / name
        authority.issue(unfinished, name, arguments.host, now, arguments.days)
        if arguments.endpoint:
            (unfinished / SESSION).write_text(foreign_client(arguments.endpoint, unfinished), encoding="utf-8")
            (unfinished / SESSION).chmod(0o600)
        if arguments.role:
            write_role(arguments.keys, name, arguments.role)
        unfinished.rename(folder)


def _revoke(arguments: argparse.Namespace) -> None:
    if not Path(arguments.keys).is_dir():
        raise UsageError(f"{arguments.keys}: no such folder, expected one with keys")
    with only_writer(arguments.keys):
        roles = registered_roles(arguments.keys)
        if arguments.name not in roles:
            known = ", ".join(sorted(roles)) or "none"
            raise UsageError(f"name {arguments.name!r}: no such key, expected one of: {known}")
        write_role(arguments.keys, arguments.name, REVOKED)
    words = f"{arguments.name} may do nothing from the next start of the bus on"
    _report(arguments, words, {"revoked": arguments.name})


def _report(arguments: argparse.Namespace, words: str, value: Mapping[str, str]) -> None:
    """Print the words, or the value as JSON."""
    if arguments.json:
        print(json.dumps(value, sort_keys=True))
    else:
        print(words)
