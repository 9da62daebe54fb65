"""Role of each name for which a key was made: `roles.json` in the folder of the keys."""

from __future__ import annotations

import json
import re
from pathlib import Path

from tailor.schemas.errors import UsageError
from tailor.schemas.parsed_files import read_json
from tailor.schemas.services import ROLES, Role

ROUTER = "router"  # the key of the gateway itself
FILE = "roles.json"
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,62}")


def check_name(name: str) -> str:
    """The name itself.

    Raises:
      UsageError: It is not fit for a certificate and a folder.
    """
    if not _NAME.fullmatch(name):
        raise UsageError(f"name {name!r}: expected letters, digits, '_', '.' or '-', at most 63")
    return name


def registered_roles(keys: str) -> dict[str, Role]:
    """Role of each name that has a valid key, without the router; empty if there is no such folder yet.

    Raises:
      UsageError: The file cannot be read, or contains an unknown role.
    """
    path = Path(keys) / FILE
    if not path.exists():
        return {}
    table = read_json(path, "the file that `tailor keys new` writes")
    if not isinstance(table, dict) or not all(role in ROLES for role in table.values()):
        raise UsageError(f"{path}: expected names with one of the roles {', '.join(ROLES)}")
    return table


def write_roles(keys: str, roles: dict[str, Role]) -> None:
    """Replace the table."""
    path = Path(keys) / FILE
    fresh = path.with_suffix(".new")
    fresh.write_text(json.dumps(roles, indent=2, sort_keys=True) + "\n")
    fresh.replace(path)
