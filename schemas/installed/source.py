"""Hashes of the source that determines the behaviour of a robot, independent of comments, docstrings and layout."""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Iterable, Iterator
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path

from tailor.schemas.installed import file, spec_of
from tailor.schemas.packages.spec import DomainSpec

ROOT = Path(__file__).resolve().parents[2]
DATA = (".pddl", ".toml", ".xml")  # beside code: problems, scenarios, drivers, scenes
CONTROL = ("executive/actions/*", "executive/belief/*", "simnodes/body.py", "tools/lockstep/action_run.py")
REASONING = ("executive/core/*", "executive/interfaces/*", "executive/planning/**/*", "executive/refinement/**/*")
WHOLE = (*CONTROL, *REASONING, "simnodes/*", "models/features/*", "models/runtime.py", "tools/lockstep/*")


@lru_cache(maxsize=8)
def episodes_sha256(domain: str) -> str:
    """Hash of what determines the episodes of a domain's actions: controllers, belief, body, sampler, domain.

    Raises:
      UsageError: There is no such domain.
    """
    return _sha256(CONTROL, spec_of(domain))


@lru_cache(maxsize=8)
def runs_sha256(domain: str) -> str:
    """Hash of what determines whole runs of a domain, models left out: the executive, the body, the domain.

    Raises:
      UsageError: There is no such domain.
    """
    return _sha256(WHOLE, spec_of(domain))


def code_text(source: str) -> str:
    """The syntax tree of Python source as text, without comments, docstrings and layout.

    It is the same for every version of Python that can parse the source.
    """
    return _text(ast.parse(source))


def _sha256(ours: Iterable[str], spec: DomainSpec) -> str:
    digest = hashlib.sha256()
    generic = (path for pattern in ours for path in ROOT.glob(pattern))
    for name, path in sorted((_name(path), path) for path in {*filter(_counts, generic), *_of_package(spec)}):
        text = path.read_text(encoding="utf-8")
        digest.update(f"{name}\0{code_text(text) if path.suffix == '.py' else text}\0".encode())
    return digest.hexdigest()


def _of_package(spec: DomainSpec) -> Iterator[Path]:
    """The driver, and the files in the folders of domain, body and sampler."""
    yield Path(str(file(spec, "driver"))).resolve()
    for written in filter(None, (spec.domain, spec.body, spec.sampler)):
        found = find_spec(written.partition(":")[0])
        if found is not None and found.origin:
            yield from filter(_counts, Path(found.origin).resolve().parent.glob("*"))


def _counts(path: Path) -> bool:
    return path.suffix in (".py", *DATA)


def _name(path: Path) -> str:
    """Path within Tailor, or within the folder that holds the package."""
    return path.relative_to(ROOT if path.is_relative_to(ROOT) else path.parents[1]).as_posix()


def _text(node: object) -> str:
    match node:
        case ast.AST():
            fields = (f"{name}={_text(value)}" for name, value in ast.iter_fields(node) if value not in (None, []))
            return f"{type(node).__name__}({','.join(fields)})"
        case list():
            return f"[{','.join(_text(item) for item in node if not _is_docstring(item))}]"
        case _:
            return repr(node)


def _is_docstring(node: object) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
