"""The reference of deployment files, generated from the settings that they are read into."""

from __future__ import annotations

import ast
import dataclasses
import inspect
import re
import textwrap
import typing
from typing import Any

from tailor.tools.cli.deployment import Deployment

HEAD = """# Configuration

A deployment is one TOML file, `--config robot.toml`, for every command on the bus: `tailor up`, `executive`, `sim` and
`units` read all of it, the others `[bus]` alone. Every key has a default; an unknown key is an error. Flags of a
command win over the file. This page is generated from the code.
"""

REFUSED = {"executive.external"}  # by `read_deployment`: its keys stand in another table


def configuration_page() -> str:
    """Markdown with one table for each table of a deployment file."""
    return "\n".join([HEAD, *_tables(Deployment, Deployment(), "")])


def _tables(cls: type, value: Any, name: str) -> list[str]:
    hints, meanings = typing.get_type_hints(cls), _meanings(cls)
    plain, nested = [], []
    for field in dataclasses.fields(cls):
        held = getattr(value, field.name)
        if dataclasses.is_dataclass(held) and not isinstance(held, type):
            nested.append((type(held), held, f"{name}.{field.name}".lstrip(".")))
        else:
            row = (field.name, _kind(hints[field.name]), repr(held), meanings.get(field.name, ""))
            plain.append("| " + " | ".join(_cell(cell, i < 3) for i, cell in enumerate(row)) + " |")
    title = f"`[{name}]`" if name else "Top level"
    summary = (inspect.getdoc(cls) or "").split("\n\n")[0]
    head = [f"\n## {title}\n", summary, "", "| key | type | default | meaning |", "|---|---|---|---|"]
    own = [*head, *plain] if plain else []
    return own + [line for each in nested if each[2] not in REFUSED for line in _tables(*each)]


def _kind(hint: Any) -> str:
    if typing.get_origin(hint) is typing.Literal:
        return ", ".join(map(repr, typing.get_args(hint)))
    return hint.__name__ if isinstance(hint, type) else str(hint).replace("typing.", "")


def _cell(text: str, code: bool) -> str:
    text = " ".join(text.replace("|", "/").split())
    return f"`{text}`" if code and text else text


def _meanings(cls: type) -> dict[str, str]:
    """Meaning of each field: its entry under "Attributes:", else the comment at its end or above it."""
    source = textwrap.dedent(inspect.getsource(cls)).splitlines()
    [definition] = ast.parse("\n".join(source)).body
    documented = dict(
        re.findall(r"^ +(\w+): (.+?)(?=\n +\w+: |\n\n|\Z)", inspect.getdoc(cls) or "", re.MULTILINE | re.DOTALL)
    )
    found = {}
    for node in getattr(definition, "body", []):
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            beside = re.search(r"#\s*(.+)$", source[(node.end_lineno or 1) - 1])
            above = re.match(r"\s*#\s*(.+)$", source[node.lineno - 2])
            comment = beside or above
            found[node.target.id] = documented.get(node.target.id) or (comment[1] if comment else "")
    return found
