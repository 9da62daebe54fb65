"""What is loaded, kept out of the garbage collector's way for a while: looking through it takes many ticks."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def gc_frozen() -> Iterator[None]:
    """Collections within look at what was made within alone; not to be nested."""
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()
