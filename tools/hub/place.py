"""Where models and data sets are pushed to or pulled from: a repository of the hub, or a folder."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from tailor.schemas.errors import UsageError

REPOSITORY = re.compile(r"[A-Za-z0-9][\w.-]*/[A-Za-z0-9][\w.-]*")
EXPECTED = "expected USER/NAME, a repository of the hub, or a folder as ./NAME"


@dataclass(frozen=True, slots=True)
class Place:
    """A repository or a folder; the other one is None."""

    repository: str | None = None
    folder: Path | None = None

    def __str__(self) -> str:
        return self.repository or str(self.folder)


def place_of(written: str) -> Place:
    """The place that a user wrote. What may be either is refused: a folder's name must publish nothing.

    Raises:
      UsageError: It is neither, or may be both; or it begins with ~ and the name of nobody here.
    """
    if written.startswith(("./", "../", "/", "~")):
        try:
            return Place(folder=Path(written).expanduser())
        except RuntimeError as error:
            raise UsageError(f"'{written}': {error}, {EXPECTED}") from None
    if not REPOSITORY.fullmatch(written):
        raise UsageError(f"'{written}': {EXPECTED}")
    if Path(written.partition("/")[0]).exists():
        raise UsageError(f"'{written}': there is a folder of that name here, {EXPECTED}")
    return Place(repository=written)
