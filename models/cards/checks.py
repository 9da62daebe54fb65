"""Whether a model is the one that its card, its place and its robot expect. Standard library alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tailor.models.cards.card import Card, identity
from tailor.schemas.errors import UsageError

COVER_TOLERANCE = 1e-6  # of a range's bounds, for decimals that were rounded


def check_identity(inside: Mapping[str, str], shape: Sequence[Any], card: Card, path: Path) -> None:
    """The ONNX file's metadata, and the shape of its input, must be what the card says.

    Raises:
      UsageError: They differ; the message names both sides.
    """
    for key, value in identity(card).items():
        if inside.get(key) != value:
            raise UsageError(f"{path}: the model's {key} is '{inside.get(key)}', expected '{value}' by its card")
    expected = len(card["arguments"])
    if len(shape) != 2 or shape[1] != expected:
        raise UsageError(f"{path}: the model takes arguments {shape}, expected (n, {expected}) by its card")


def check_place(card: Card, place: str, folder: Path) -> None:
    """A model must lie where its card says that it belongs: "robot/action/kind".

    Raises:
      UsageError: It does not.
    """
    name = f"{card['robot']}/{card['action']}/{card['kind']}"
    if name != place:
        raise UsageError(f"{folder}: holds a model of {name}, expected {place} by its place in the zoo")


def check_ranges(card: Card, declared: Mapping[str, tuple[float, float]], path: Path) -> None:
    """A model must have seen the ranges, by argument, that its action declares.

    Raises:
      UsageError: It has seen less, or does not know the argument.
    """
    seen = {argument["name"]: argument for argument in card["arguments"]}
    for name, (lower, upper) in declared.items():
        if name not in seen:
            raise UsageError(f"{path}: the model knows no argument '{name}' (its arguments: {', '.join(seen)})")
        low, high = seen[name]["lower"], seen[name]["upper"]
        if lower < low - COVER_TOLERANCE or upper > high + COVER_TOLERANCE:
            raise UsageError(
                f"{path}: {name} was learned in [{low:g}, {high:g}] {seen[name]['unit']}, "
                f"expected to cover [{lower:g}, {upper:g}] as the action declares"
            )


def check_trained_with(card: Card, installed: Mapping[str, str], path: Path) -> None:
    """A refinement gate judges the choices of the action models that it was learned with, and of no others.

    Args:
      card: Of the tree.
      installed: SHA-256 of the robot's models by "action/kind".
      path: Where the tree lies.

    Raises:
      UsageError: One of these models is not there, or another.
    """
    if not card.get("models"):
        raise UsageError(f"{path}: card names no models that the tree was learned with, expected those of the robot")
    for name, sha256 in card["models"].items():
        found = installed.get(name, "missing")
        if found != sha256:
            raise UsageError(
                f"{path}: was learned when {name} was {sha256[:12]}…, which is {found[:12]} here: train it again "
                f"with `tailor train-gate`, or set refinement.gate = false"
            )
