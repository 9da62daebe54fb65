"""Chooses the folder that trained models are written to; never the folder of an installed package."""

from __future__ import annotations

import os
from pathlib import Path

from tailor.models.runtime import ZOO
from tailor.schemas.errors import UsageError


def target_zoo(zoo: Path | None, own: Path = ZOO) -> Path:
    """Folder to write models to.

    Args:
      zoo: The folder that the user named, None if none was named.
      own: The package's own zoo, the default in an editable checkout.

    Returns:
      `zoo` if named; otherwise `own`, if it lies in a checkout and is writable.

    Raises:
      UsageError: No folder is named and `own` is part of an installation.
    """
    if zoo is not None:
        return zoo
    if not _is_checkout(own.parents[1]) or not os.access(own, os.W_OK):
        raise UsageError(f"models are not written into the installed package ({own}), expected --zoo DIR")
    return own


def _is_checkout(root: Path) -> bool:
    """Whether a folder is the root of the source tree; the folder above an installed package has no pyproject.toml."""
    return (root / "pyproject.toml").is_file()
