"""Puts a model and its card into a zoo, whole or not at all: a full disk or a kill leaves the model that was there."""

from __future__ import annotations

import os
from pathlib import Path

from tailor.models.cards.card import Card, card_path, sha256_of, write_card


def place(zoo: Path, content: bytes, card: Card) -> Path:
    """Write `zoo/robot/action/kind.onnx`, and its card with the content's hash; returns the ONNX file's path."""
    path: Path = zoo / card["robot"] / card["action"] / f"{card['kind']}.onnx"
    path.parent.mkdir(parents=True, exist_ok=True)
    model, words = (_beside(kept) for kept in (path, card_path(path)))
    try:
        model.write_bytes(content)
        write_card(words, {**card, "sha256": sha256_of(content)})
        model.replace(path)
        words.replace(card_path(path))
    finally:
        for left in (model, words):
            left.unlink(missing_ok=True)
    return path


def _beside(path: Path) -> Path:
    return path.with_name(f".{path.name}.{os.getpid()}")
