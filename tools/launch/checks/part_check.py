"""Checks that the objects that a robot's package names are there, without importing them.

A launcher has no use for physics, and a process that cannot import its part would be started again and again.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

from tailor.schemas.packages.spec import DomainSpec

LATER = ("doubts", "body", "sampler", "features", "draw", "generator", "scene")  # imported by who needs them


def faults_of_parts(spec: DomainSpec) -> Iterator[str]:
    """Objects of the package's own modules that are not where its spec says.

    Those of other packages may be installed on another machine: a simulator is not needed beside the hardware.
    """
    for field in LATER:
        module, _, attribute = getattr(spec, field).partition(":")
        own = module.partition(".")[0] == spec.package.partition(".")[0]
        if own and (fault := _fault(module, attribute)):
            yield f"{field} = '{getattr(spec, field)}': {fault}"


def _fault(module: str, attribute: str) -> str:
    try:
        found = find_spec(module)
    except Exception as error:  # its parent package cannot be imported
        return f"{type(error).__name__}: {error}"
    if found is None:
        return f"there is no module '{module}'"
    if not attribute or found.origin is None or not found.origin.endswith(".py"):
        return ""
    try:
        names = set(_names(ast.parse(Path(found.origin).read_bytes())))
    except SyntaxError as error:
        return f"{error.msg} ({Path(found.origin).name}, line {error.lineno})"
    return "" if names & {attribute, "*", "__getattr__"} else f"module '{module}' has no '{attribute}'"


def _names(parent: ast.AST) -> Iterator[str]:
    """Names that a module's own statements bind or use, also under conditions; "*" for all of another module."""
    for each in ast.iter_child_nodes(parent):
        if isinstance(each, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            yield each.name
        elif isinstance(each, ast.Import | ast.ImportFrom):
            yield from (alias.asname or alias.name.partition(".")[0] for alias in each.names)
        elif isinstance(each, ast.Name):
            yield each.id
        else:
            yield from _names(each)
