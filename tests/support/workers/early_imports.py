"""Workers begin to import the test modules at different places, so that what one has compiled the others read.

pytest rewrites the assertions of each module: 8 s of CPU time. Workers that go through the modules side by side would
all do it for each, and on a fresh clone nobody has done it before.
"""

from collections.abc import Iterable
from contextlib import suppress
from importlib import import_module
from pathlib import Path

import pytest


def import_early(root: Path, chosen: Iterable[Path], number: int, workers: int) -> None:
    """Import the test modules that were chosen, from this worker's share on; faults are left to the collection.

    Args:
      root: Folder that holds the package `tests`.
      chosen: Files and folders to run.
      number: Of this worker, from 0.
      workers: How many there are.
    """
    files = sorted({file for path in chosen for file in ([path] if path.is_file() else path.rglob("test_*.py"))})
    names = [".".join(file.relative_to(root).with_suffix("").parts) for file in files if file.is_relative_to(root)]
    begin = len(names) * number // workers
    for name in names[begin:] + names[:begin]:
        with suppress(Exception, pytest.skip.Exception):
            import_module(name)
