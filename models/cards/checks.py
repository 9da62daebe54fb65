"""Checks that a model is the one that its card and its place expect. Standard library only."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tailor.models.cards.card import Card, identity
from tailor.schemas.errors import UsageError


def check_identity(inside: Mapping[str, str], shape: Sequence[Any], card: Card, path: Path) -> None:
    """Compare metadata and input shape of an ONNX file with its card.

    Args:
      inside: Metadata of the ONNX file.
      shape: Shape of its input.
      card: Its card.
      path: The ONNX file, for errors.

    Raises:
      UsageError: They differ; the message names both values.
    """
    for key, value in identity(card).items():
        if inside.get(key) != value:
            raise UsageError(f"{path}: the model's {key} is '{inside.get(key)}', expected '{value}' by its card")
    expected = len(card["arguments"])
    if len(shape) != 2 or shape[1] != expected:
        raise UsageError(f"{path}: the model takes arguments {shape}, expected (n, {expected}) by its card")


def check_place(card: Card, place: str, folder: Path) -> None:
    """Compare the place of a model in the zoo, "robot/action/kind", with its card.

    Raises:
      UsageError: They differ.
    """
    name = f"{card['robot']}/{card['action']}/{card['kind']}"
    if name != place:
        raise UsageError(f"{folder}: holds a model of {name}, expected {place} by its place in the zoo")
