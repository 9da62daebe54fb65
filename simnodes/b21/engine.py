"""PyBullet, loaded when a body is made: an optional dependency, and one that prints when it is imported."""

from __future__ import annotations

import os
import sys
import weakref
from functools import cache
from typing import Any

from tailor.schemas.errors import UsageError


@cache
def pybullet() -> Any:
    """The module, without its greeting: standard error is for people who have to know something.

    Raises:
      ModuleNotFoundError: It is not installed; the command line names the extra.
    """
    sys.stderr.flush()
    stderr, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    try:
        import pybullet as module
    finally:
        os.dup2(stderr, 2)
        os.close(stderr)
        os.close(nowhere)
    return module


class Engine:
    """One world of PyBullet. A new one repeats its states bit for bit; one that is reset does not.

    Attributes:
      client: Number of the world in every call.
      close: Ends it; garbage collection does so, too.
    """

    def __init__(self) -> None:
        """Start an empty world without display."""
        bullet = pybullet()
        self.client: int = bullet.connect(bullet.DIRECT)
        if self.client < 0:
            raise UsageError("PyBullet starts no further world: too many are open in this process")
        self.close = weakref.finalize(self, _disconnect, bullet, self.client)


def _disconnect(bullet: Any, client: int) -> None:
    if bullet.isConnected(client):
        bullet.disconnect(client)
