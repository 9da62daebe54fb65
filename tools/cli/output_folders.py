"""Folders that a command is to write: whole, or not at all."""

from __future__ import annotations

import errno
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from tailor.runtime.stopping import undone_before_the_end
from tailor.schemas.errors import UsageError

NO_SPACE = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


@contextmanager
def temporary_beside(target: Path) -> Iterator[Path]:
    """A folder on the same disk as a target, from which moving is one step; removed at the end of the block.

    So are those above it that were made for it, unless something has been moved into them.

    Raises:
      UsageError: The folder cannot be made, or the disk is full. Copying names the file that it reads, writing none.
    """
    made = [parent for parent in target.parents if not parent.exists()]
    with undone_before_the_end():
        folder = _made_beside(target)
        try:
            yield folder
        except OSError as error:
            if error.errno not in NO_SPACE:
                raise
            raise UsageError(f"{target.parent}: {error.strerror}, expected space for what is written there") from None
        finally:
            shutil.rmtree(folder, ignore_errors=True)
            for parent in made:
                with suppress(OSError):
                    parent.rmdir()


def _made_beside(target: Path) -> Path:
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        folder = Path(tempfile.mkdtemp(dir=target.parent, prefix=f".{target.name}-"))
        folder.chmod(0o755)
    except OSError as error:
        raise UsageError(f"{target}: {error.strerror}, expected a folder that can be written") from error
    return folder
