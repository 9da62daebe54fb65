"""The table of rooms (rooms.toml) and the imports of every module of ours, as data."""

import ast
import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[3]
ROOMS_FILE = Path(__file__).with_name("rooms.toml")
ROOMS = tomllib.loads(ROOMS_FILE.read_text())
ONE_PLACE: dict[str, list[str]] = ROOMS.pop("one_place")
OURS = set(ROOMS["."])
MODULES = frozenset(p.relative_to(ROOT).as_posix() for folder in OURS for p in (ROOT / folder).rglob("*.py"))


class Arrow(NamedTuple):
    """Two rooms of one folder, the first of which imports the second."""

    folder: str
    importer: str
    imported: str

    def __str__(self) -> str:
        return f"{self.folder}: {self.importer} -> {self.imported}"


def module_path(name: str) -> str | None:
    """File of a dotted name `tailor.…`, or None if the name is no module of ours."""
    stem = name.removeprefix("tailor.").replace(".", "/")
    return next((path for path in (f"{stem}.py", f"{stem}/__init__.py") if path in MODULES), None)


@cache
def imported_names(path: str) -> frozenset[str]:
    """Dotted names of the modules that a file imports anywhere: at the top, inside functions, under TYPE_CHECKING."""
    names: set[str] = set()
    for node in ast.walk(ast.parse((ROOT / path).read_text())):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            if node.level or node.module is None:
                raise ValueError(f"{path}, line {node.lineno}: relative import, expected tailor.…")
            members = {f"{node.module}.{alias.name}" for alias in node.names}
            names |= {member if module_path(member) else node.module for member in members}
    return frozenset(names)


def imported_modules(path: str) -> frozenset[str]:
    """Files of ours that a file imports. `from package import module` imports the module, not the package."""
    names = (name for name in imported_names(path) if name.startswith("tailor."))
    return frozenset(p for name in names if (p := module_path(name)))


def room_in(folder: str, path: str) -> str:
    """Room of `folder` that holds the file."""
    inside = path if folder == "." else path.removeprefix(f"{folder}/")
    return inside.split("/")[0] if "/" in inside else "root"


def arrow_between(importer: str, imported: str) -> Arrow | None:
    """Arrow that the import of one file by another is, or None inside a room."""
    parts = [".", *("/".join(importer.split("/")[:n]) for n in range(1, importer.count("/") + 1))]
    folder = [p for p in parts if p == "." or imported.startswith(f"{p}/")][-1]
    arrow = Arrow(folder, room_in(folder, importer), room_in(folder, imported))
    return None if arrow.importer == arrow.imported else arrow


def is_allowed(arrow: Arrow) -> bool:
    """Whether the table has the arrow."""
    row = ROOMS.get(arrow.folder, {}).get(arrow.importer)
    return row is not None and arrow.imported in row["imports"]


def all_imports() -> Iterator[tuple[str, str]]:
    """Pairs of files of ours, the first of which imports the second."""
    for importer in MODULES:
        for imported in imported_modules(importer):
            yield importer, imported


def circles(graph: dict[str, set[str]]) -> set[str]:
    """Nodes of a directed graph that lie on a circle."""

    def reachable(start: str) -> set[str]:
        seen: set[str] = set()
        frontier = [start]
        while frontier:
            new = graph.get(frontier.pop(), set()) - seen
            seen |= new
            frontier += new
        return seen

    return {node for node in graph if node in reachable(node)}
