"""The reference of deployment files, generated from the settings that they are read into."""

from __future__ import annotations

import ast
import dataclasses
import inspect
import itertools
import json
import re
import textwrap
import typing
from typing import Any

from tailor.tools.cli.systems.deployment import Deployment

HEAD = """# Configuration

A deployment is one TOML file, `--config robot.toml`, for every command on the bus: `tailor up`, `executive`, `sim` and
`units` read all of it, the others `[bus]` alone. Every key has a default; an unknown key is an error. Flags of a
command win over the file. This page is generated from the code.
"""

REFUSED = {"executive.external"}  # by `read_deployment`: its keys stand in another table
MEANINGS = {  # of fields whose comments in the code do not suffice here
    "Settings.seed": "random seed",
    "RefinementSettings.solver": "auto: by the structure of the sequence",
    "RefinementSettings.worth_s": "seconds; see patience",
    "PlannerCommand.command": "as in a shell, or a planner's name; empty: none",
    "PlannerCommand.costs": "steps: the planner's first plan; models: of several the one predicted to be fastest",
}


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
            row = (field.name, _kind(hints[field.name]), _toml(held), meanings.get(field.name, ""))
            plain.append("| " + " | ".join(_cell(cell, i < 3) for i, cell in enumerate(row)) + " |")
    title = f"`[{name}]`" if name else "Top level"
    summary = (inspect.getdoc(cls) or "").split("\n\n")[0]
    head = [f"\n## {title}\n", summary, "", "| key | type | default | meaning |", "|---|---|---|---|"]
    own = [*head, *plain] if plain else []
    return own + [line for each in nested if each[2] not in REFUSED for line in _tables(*each)]


def _kind(hint: Any) -> str:
    if typing.get_origin(hint) is typing.Literal:
        return ", ".join(map(_toml, typing.get_args(hint)))
    return hint.__name__ if isinstance(hint, type) else "list"


def _toml(value: Any) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(map(_toml, value))}]"
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        held = {field.name: getattr(value, field.name) for field in dataclasses.fields(value)}
        return f"{{ {', '.join(f'{name} = {_toml(each)}' for name, each in held.items() if each is not None)} }}"
    return json.dumps(value)


def _cell(text: str, code: bool) -> str:
    text = " ".join(text.replace("|", "/").split())
    return f"`{text}`" if code else text.replace("<", "&lt;")  # a name such as <robot> is no HTML


def _meanings(cls: type) -> dict[str, str]:
    """Meaning of each field: of `MEANINGS`, under "Attributes:", in its comment, or in a sentence of the docstring.

    Comment lines above a field are its own where it has no other text, else the end of the comment before them.
    """
    source = textwrap.dedent(inspect.getsource(cls)).splitlines()
    [definition] = ast.parse("\n".join(source)).body
    text = inspect.getdoc(cls) or ""
    documented = dict(re.findall(r"^ +(\w+): (.+?)(?=\n +\w+: |\n\n|\Z)", text, re.MULTILINE | re.DOTALL))
    sentences = dict(re.findall(r"`(\w+)` is (.+?)\.(?:\s|\Z)", text, re.DOTALL))
    found: dict[str, str] = {}
    before = ""
    for node in getattr(definition, "body", []):
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            name = node.target.id
            beside = re.search(r"#\s*(.+)$", source[(node.end_lineno or 1) - 1])
            own = documented.get(name) or (beside[1] if beside else sentences.get(name, ""))
            above = _comment_above(source, node.lineno - 1)
            if own and before and before not in documented:
                found[before] = f"{found[before]} {above}".strip()
            found[name] = MEANINGS.get(f"{cls.__name__}.{name}") or own or above
            before = name
    return found


def _comment_above(source: list[str], line: int) -> str:
    comments = itertools.takewhile(bool, (re.match(r"\s*#\s*(.+)$", text) for text in reversed(source[:line])))
    return " ".join(reversed([comment[1] for comment in comments if comment]))
