"""Writes a model and its card into a zoo atomically: a full disk or a kill keeps the previous model."""

from __future__ import annotations

import os
from pathlib import Path

from tailor.models.cards.card import Card, card_path, sha256_of, write_card


def write_model(zoo: Path, content: bytes, card: Card) -> Path:
    """Write `zoo/robot/action/kind.onnx`, and its card with the content's SHA-256; returns the ONNX file's path."""
    path: Path = zoo / card["robot"] / card["action"] / f"{card['kind']}.onnx"
    path.parent.mkdir(parents=True, exist_ok=True)
    model, card_file = (_temporary(final) for final in (path, card_path(path)))
    try:
        model.write_bytes(content)
        write_card(card_file, {**card, "sha256": sha256_of(content)})
        model.replace(path)
        card_file.replace(card_path(path))
    finally:
        for left in (model, card_file):
            left.unlink(missing_ok=True)
    return path


def _temporary(path: Path) -> Path:
    return path.with_name(f".{path.name}.{os.getpid()}")
