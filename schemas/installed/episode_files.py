"""Source files that determine a robot's episodes: controllers, belief filters, body, sampler, measures of its world.

A model is true of the source that its episodes were simulated with. They are found by following imports, without
importing anything.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from importlib.util import find_spec, resolve_name
from pathlib import Path

from tailor.schemas.installed import spec_of
from tailor.schemas.installed.source_text import content_sha256
from tailor.schemas.packages.spec import DomainSpec

OURS = "tailor"
RUNS_ACTIONS = "tailor.tools.lockstep.action_run"
DECLARATIONS = ("tailor.schemas.", "tailor.executive.interfaces.")  # types without behaviour, unless data lie beside
BLOCKS = ("body", "orelse", "finalbody", "handlers", "cases")  # fields with the statements of a statement
DATA = (".toml", ".xml")  # beside the body: axes and limits of its driver, its scene; in schemas: measures of furniture


def episode_files(domain: str) -> dict[str, str]:
    """Files that determine a robot's episodes, of a domain by name.

    Returns:
      SHA-256 by path inside the package; "executive/actions/reach.py" for files of Tailor.

    Raises:
      UsageError: There is no such domain.
    """
    return {shown: content_sha256(path) for shown, path in sorted(episode_paths(spec_of(domain)).items())}


def episode_paths(spec: DomainSpec) -> dict[str, Path]:
    """All that domain, body and sampler import, with the data beside the body and beside measures that both sides use.

    Returns:
      File by path inside the package.
    """
    starts = [written.partition(":")[0] for written in (spec.domain, spec.body, spec.sampler) if written]
    found = _imported([*starts, RUNS_ACTIONS])
    body = spec.body.partition(":")[0]
    with_data = {module for module in found if module == body or module.startswith(DECLARATIONS)}
    files = {_shown(module, path): path for module, path in found.items()}
    for module in with_data:
        folder = _shown(module, found[module]).rpartition("/")[0]
        files |= {f"{folder}/{path.name}": path for path in _data_beside(found[module])}
    return files


def _imported(starts: Iterable[str]) -> dict[str, Path]:
    """Modules that are reached by imports inside the packages of `starts` and of Tailor, with their files."""
    packages = {OURS, *(start.partition(".")[0] for start in starts)}
    found: dict[str, Path] = {}
    waiting, looked_up = list(starts), set[str]()
    while waiting:
        module = waiting.pop()
        if module in looked_up or module.partition(".")[0] not in packages:
            continue
        looked_up.add(module)
        path = _file_of(module)
        if path is not None and not _declares(module, path):
            found[module] = path
            waiting.extend(_imports(module, path))
    return found


def _declares(module: str, path: Path) -> bool:
    return module.startswith(DECLARATIONS) and not _data_beside(path)


def _data_beside(path: Path) -> list[Path]:
    return [beside for suffix in DATA for beside in path.parent.glob(f"*{suffix}")]


def _imports(module: str, path: Path) -> Iterator[str]:
    """Dotted names that a module imports, wherever in its text; of `from a import b` both a and a.b."""
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
    for node in _statements(ast.parse(path.read_bytes())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            origin = resolve_name("." * node.level + (node.module or ""), package)
            yield from (f"{origin}.{alias.name}" for alias in node.names)
            yield origin


def _statements(tree: ast.Module) -> Iterator[ast.AST]:
    """The module and all its statements, but no expressions: they hold no import, and are most of the tree."""
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        yield node
        for field in BLOCKS:
            waiting.extend(getattr(node, field, ()))


def _file_of(module: str) -> Path | None:
    """File of a module, found without importing it; None if it has none."""
    top, *rest = module.split(".")
    for place in _places(top):
        base = place.joinpath(*rest)
        for path in (base / "__init__.py", base.with_name(f"{base.name}.py")):
            if path.is_file():
                return path
    return None


def _places(top: str) -> list[Path]:
    """Folders of a top-level package; the single file of a top-level module counts as one."""
    found = find_spec(top)
    if found is None:
        return []
    if found.submodule_search_locations is None:
        return [Path(found.origin).with_suffix("")] if found.origin else []
    return [Path(place) for place in found.submodule_search_locations]


def _shown(module: str, path: Path) -> str:
    """Path of a module's file inside its package."""
    parts = module.removeprefix(f"{OURS}.").split(".")
    return "/".join([*parts, "__init__.py"] if path.name == "__init__.py" else [*parts[:-1], f"{parts[-1]}.py"])
