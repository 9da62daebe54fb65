"""Reads a model together with its card, also where a kill interrupted their publication.

Two files cannot be replaced in one step. So the new card waits beside the old one before the new model takes its place:
the model's bytes decide which of both cards holds. Reading changes nothing, as whoever reads may have no right to.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tailor.models.cards.card import MAX_MODEL_BYTES, card_path, read_bytes, read_card, sha256_of
from tailor.schemas.errors import UsageError


def waiting_path(path: Path) -> Path:
    """Where the next content of a model or a card waits until it is published."""
    return path.with_name(f".{path.name}.next")


def read_model(path: Path) -> tuple[bytes, dict[str, Any]]:
    """Content of an ONNX file, and the card that has its hash.

    Raises:
      UsageError: The file or its card is missing, too large or damaged, or no card has the model's hash.
    """
    errors: list[Exception] = []
    own = card_path(path)
    for card_file in (own, waiting_path(own), own):  # again: a writer may have published both in between
        try:
            return read_model_with(path, card_file)
        except (UsageError, FileNotFoundError) as error:
            errors.append(error)
    raise errors[0] from None


def read_model_with(path: Path, card_file: Path) -> tuple[bytes, dict[str, Any]]:
    """Content of an ONNX file and of one card; raises UsageError unless the card has the model's hash."""
    card = read_card(card_file)
    content = read_bytes(path, MAX_MODEL_BYTES)
    if sha256_of(content) != card["sha256"]:
        raise UsageError(f"{path}: sha256 is {sha256_of(content)[:12]}…, expected {card['sha256'][:12]}… by its card")
    return content, card
