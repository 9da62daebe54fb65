"""Writes a model and its card into a zoo: whatever interrupts it, either the old pair or the new one loads.

The new files wait under other names until both are whole. The model takes its place first; from then on readers find
its card where it waits (`model_files`). The next writer publishes or removes what an interrupted one has left.
"""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from tailor.models.cards.card import Card, card_path, sha256_of, write_card
from tailor.models.cards.model_files import read_model_with, waiting_path
from tailor.schemas.errors import UsageError


def write_model(zoo: Path, content: bytes, card: Card) -> Path:
    """Write `zoo/robot/action/kind.onnx`, and its card with the content's SHA-256; returns the ONNX file's path."""
    path: Path = zoo / card["robot"] / card["action"] / f"{card['kind']}.onnx"
    replace_model(path, content, card)
    return path


def replace_model(path: Path, content: bytes, card: Card) -> None:
    """Write an ONNX file, and its card with the content's SHA-256, in place of those that are there.

    Raises:
      OSError: They cannot be written; the old ones are still there.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    new_model, new_card = waiting_path(path), waiting_path(card_path(path))
    with _lock_of(path.parent):
        _settle(path)
        try:
            new_model.write_bytes(content)
            write_card(new_card, {**card, "sha256": sha256_of(content)})
            new_model.replace(path)
            new_card.replace(card_path(path))
        finally:
            _settle(path)


def _settle(path: Path) -> None:
    """Finish an interrupted publication if its model is in place already, else remove what waits."""
    new_card = waiting_path(card_path(path))
    with suppress(UsageError):  # nothing waits, or it is not whole, or of another model
        read_model_with(path, new_card)
        new_card.replace(card_path(path))
    for left in (new_card, waiting_path(path)):
        left.unlink(missing_ok=True)


@contextmanager
def _lock_of(folder: Path) -> Iterator[None]:
    """One writer at a time; a kill releases the lock. Some network file systems lock no folders: they go without."""
    opened = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):
            fcntl.flock(opened, fcntl.LOCK_EX)
        yield
    finally:
        os.close(opened)
