"""Source of an executive by folder, for the provenance of a recording: a later replay compares it with its own."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

from tailor.schemas.installed import spec_of
from tailor.schemas.installed.source import ROOT

SHOWN_DIGITS = 12
STARTS = ("executive", "models/features", "models/runtime.py", "models/inference.py", "robots", "schemas")
NOT_RUN = ("executive/domains", "schemas/installed", "schemas/ros2")  # of all domains only this robot's is
SUFFIXES = (".py", ".pddl", ".toml")


def core_source(domain: str) -> dict[str, str]:
    """First digits of the SHA-256 by folder, of all that a replay runs: e.g. {"executive/core": "0f3a…", …}.

    The bytes count, comments too: that takes milliseconds, while the meaning (`source.py`) takes a second.

    Raises:
      UsageError: There is no such domain.
    """
    digests: dict[str, hashlib._Hash] = {}
    for folder, name, path in sorted(set(_files(domain))):
        digest = digests.setdefault(folder, hashlib.sha256())
        digest.update(f"{name}\0".encode() + _content(path) + b"\0")
    return {folder: digest.hexdigest()[:SHOWN_DIGITS] for folder, digest in digests.items()}


def _files(domain: str) -> Iterator[tuple[str, str, Path]]:
    """Folder, name and path of each file; of all domains only that of this robot."""
    own = _own(spec_of(domain).domain.partition(":")[0])
    if own is not None:
        shown = own.relative_to(ROOT).as_posix() if own.is_relative_to(ROOT) else own.name
        yield from ((shown, path.relative_to(own).as_posix(), path) for path in _sources(own))
    for start in STARTS:
        for path in _sources(ROOT / start):
            name = path.relative_to(ROOT).as_posix()
            if not name.startswith(NOT_RUN):
                yield start if path.parent == ROOT / start else "/".join(name.split("/")[:2]), name, path


def _own(module: str) -> Path | None:
    """Folder of a domain's module. A module of no package is a file alone: beside it lies what others installed."""
    found = find_spec(module)
    if found is None or not found.origin:
        return None
    path = Path(found.origin).resolve()
    return path.parent if found.parent else path


def _content(path: Path) -> bytes:
    """Bytes of a file; none of one that this user may not read, or that has just gone: no start fails for it."""
    try:
        return path.read_bytes()
    except OSError:
        return b""


def _sources(start: Path) -> Iterator[Path]:
    if start.is_file():
        yield start
    for suffix in SUFFIXES:
        yield from filter(Path.is_file, start.rglob(f"*{suffix}"))  # editors leave links that lead nowhere
