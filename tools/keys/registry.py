"""Role of each name for which a key was made: `roles.json` in the folder of the keys."""

from __future__ import annotations

import fcntl
import ipaddress
import json
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import cast

from tailor.runtime.bus.rights.credentials import AUTHORITY
from tailor.schemas.errors import UsageError
from tailor.schemas.parsed_files import read_json
from tailor.schemas.services import ROLES, Role

ROUTER = "router"  # the key of the gateway itself
FILE = "roles.json"
FRESH = "roles.new"  # while it is written
AUTHORITY_KEY = "authority-key.pem"  # stays on the machine where keys are made
REVOKED = "revoked"  # in the place of a role: rights go by the name, so a name never serves a second key
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,62}")
_LABEL = r"[A-Za-z0-9_]([A-Za-z0-9_-]{0,61}[A-Za-z0-9_])?"
_HOST = re.compile(rf"(\*\.)?{_LABEL}(\.{_LABEL})*")


def check_name(name: str) -> str:
    """The name itself.

    Raises:
      UsageError: It is not fit for a certificate and a folder.
    """
    if not _NAME.fullmatch(name):
        raise UsageError(f"name {name!r}: expected letters, digits, '_', '.' or '-', at most 63")
    if name in (FILE, FRESH, AUTHORITY, AUTHORITY_KEY):
        raise UsageError(f"name {name!r}: a file in the folder of the keys has it, expected another one")
    return name


def check_host(host: str) -> str:
    """The host itself.

    Raises:
      UsageError: It is neither an address nor a name, so no client would accept a certificate with it.
    """
    try:
        ipaddress.ip_address(host)
    except ValueError:
        if not _HOST.fullmatch(host) or len(host) > 253:
            raise UsageError(f"--host {host!r}: expected a name or an address, such as robot.local") from None
    return host


def registered_roles(keys: str) -> dict[str, Role]:
    """Role of each name that has a valid key, without the router; empty if there is no such folder yet.

    Raises:
      UsageError: The file cannot be read, or contains an unknown role.
    """
    return {name: cast("Role", role) for name, role in _table(keys).items() if role != REVOKED}


def check_unused(keys: str, name: str) -> None:
    """Refuse a name for which a key was made before, wherever the key is now, and revoked or not.

    Raises:
      UsageError: There was one.
    """
    if name in _table(keys):
        raise UsageError(f"name {name!r}: a key of it was made before, expected a new name")


@contextmanager
def only_writer(keys: str) -> Iterator[None]:
    """Hold a folder of keys, made if there is none: another command that changes it waits. A kill releases it.

    Raises:
      OSError: It cannot be made.
    """
    Path(keys).mkdir(mode=0o700, parents=True, exist_ok=True)
    opened = os.open(keys, os.O_RDONLY)
    try:
        with suppress(OSError):  # some network file systems lock no folders: they go without
            fcntl.flock(opened, fcntl.LOCK_EX)
        yield
    finally:
        os.close(opened)


def _table(keys: str) -> dict[str, str]:
    """All names ever registered, with their roles or REVOKED."""
    path = Path(keys) / FILE
    if Path(keys).is_file():
        raise UsageError(f"{keys}: is a file, expected a folder of keys")
    if not path.exists():
        return {}
    table = read_json(path, "the file that `tailor keys new` writes")
    if not isinstance(table, dict) or not all(role in (*ROLES, REVOKED) for role in table.values()):
        raise UsageError(f"{path}: expected names with one of the roles {', '.join(ROLES)}")
    return table


def write_role(keys: str, name: str, role: str) -> None:
    """Register a role, or REVOKED, for a name; the caller is the only writer.

    Raises:
      UsageError: The file cannot be read, or not be written, as on a full disk, and is as it was.
    """
    path = Path(keys) / FILE
    text = json.dumps({**_table(keys), name: role}, indent=2, sort_keys=True) + "\n"
    fresh = path.with_name(FRESH)
    try:
        fresh.write_text(text, encoding="utf-8")
        fresh.replace(path)
    except OSError as error:  # that of a full disk names no file
        with suppress(OSError):
            fresh.unlink()
        raise UsageError(f"{path}: {error.strerror}, expected a file that can be written") from error
