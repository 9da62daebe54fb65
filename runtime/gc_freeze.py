"""Excludes loaded objects from garbage collection: a full collection of them takes many ticks."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def gc_frozen() -> Iterator[None]:
    """Limit collections inside the block to objects created inside it. Do not nest."""
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()
