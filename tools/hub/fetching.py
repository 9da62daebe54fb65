"""Fetches the files of a repository of the hub, or of a folder, once their sizes are known and allowed."""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Mapping
from fnmatch import fnmatchcase
from pathlib import Path

from tailor.schemas.errors import UsageError
from tailor.tools.hub.checksums import checked_files
from tailor.tools.hub.client import download, file_sizes
from tailor.tools.hub.place import Place


def fetched(place: Place, kind: str, revision: str | None, limits: Mapping[str, int], into: Path) -> list[Path]:
    """Get the files of a place that its checksums list into an empty folder; returns their paths there.

    Args:
      place: Where `push` put them.
      kind: "model" or "dataset".
      revision: Branch, tag or commit of a repository; None: the newest.
      limits: The most bytes of a file, by pattern of those that are fetched.
      into: An empty folder.

    Raises:
      UsageError: There is no such place, a file is too large (nothing is fetched then), missing, or differs from its
        checksum.
    """
    _fetch(place, kind, revision, limits, into)
    _check_sizes(place, _sizes(into, into.rglob("*")), limits)  # a hub may send more than it announced
    try:
        files = checked_files(into, kind)
    except UsageError as error:
        raise UsageError(f"{place}: {error}") from None
    listed = {into / file for file in files}
    for path in [path for path in into.rglob("*") if path.is_file() and path not in listed]:
        path.unlink()  # no checksum covers it
    return files


def _fetch(place: Place, kind: str, revision: str | None, limits: Mapping[str, int], into: Path) -> None:
    if place.folder is None:
        repository = str(place.repository)
        _check_sizes(place, file_sizes(repository, kind, revision), limits)
        download(repository, kind, revision, list(limits), into)
        return
    if not place.folder.is_dir():
        raise UsageError(f"{place}: no such folder, expected what `tailor models push --to {place}` wrote")
    sizes = _sizes(place.folder, (file for pattern in limits for file in place.folder.glob(pattern)))
    _check_sizes(place, sizes, limits)
    for name in sizes:
        (into / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(place.folder / name, into / name)


def _sizes(folder: Path, paths: Iterable[Path]) -> dict[str, int]:
    """Bytes of each regular file, by its path in a folder."""
    return {path.relative_to(folder).as_posix(): path.stat().st_size for path in paths if path.is_file()}


def _check_sizes(place: Place, sizes: Mapping[str, int], limits: Mapping[str, int]) -> None:
    for name, size in sizes.items():
        allowed = [limit for pattern, limit in limits.items() if fnmatchcase(name, pattern)]
        if allowed and size > max(allowed):
            raise UsageError(f"{place}/{name}: has {size} bytes, expected at most {max(allowed)}")
