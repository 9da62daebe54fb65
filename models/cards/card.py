"""Model cards: what a model is, what it was learned from, how good it is, and how to know it again.

A card is a JSON file beside its ONNX file: `duration.onnx` has `duration.card.json`.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tailor.models.cards.card_shape import card_error
from tailor.schemas.errors import UsageError

FORMAT = 1
# "benefit" is the refinement gate; the models that ship were published under this kind
KINDS = ("duration", "success", "energy", "benefit")
UNITS = {"duration": "s", "energy": "J"}  # of what a model predicts; a probability has none
MAX_CARD_BYTES = 1 << 20  # ours are some 20 kB
MAX_MODEL_BYTES = 64 << 20  # ours are well below 1 MB
# what a card must say; docs/learning.md explains each
FIELDS = (
    "robot", "action", "kind", "features", "arguments", "outputs", "output_range", "episodes", "learner", "test",
    "sha256", "golden", "versions", "command",
)  # fmt: skip

Card = Mapping[str, Any]


def card_path(model: Path) -> Path:
    """Where the card of an ONNX file lies."""
    return model.with_name(f"{model.stem}.card.json")


def sha256_of(content: bytes) -> str:
    """Hexadecimal SHA-256, 64 digits."""
    return hashlib.sha256(content).hexdigest()


def identity(card: Card) -> dict[str, str]:
    """What the ONNX file repeats of its card in its own metadata; the two must agree."""
    names = " ".join(argument["name"] for argument in card["arguments"])
    return {**{key: str(card[key]) for key in ("robot", "action", "kind", "features")}, "arguments": names}


def read_bytes(path: Path, limit: int) -> bytes:
    """A file's content, if it is there and not larger than `limit` bytes.

    Raises:
      UsageError: It is missing, not a file, or too large.
    """
    if not path.is_file():
        raise UsageError(f"{path}: no such file, expected an action model and its card (`tailor train` makes them)")
    size = path.stat().st_size
    if size > limit:
        raise UsageError(f"{path}: has {size} bytes, expected at most {limit}")
    return path.read_bytes()


def read_card(path: Path) -> dict[str, Any]:
    """Read a card and check that it says all that a card says.

    Raises:
      UsageError: The file is missing, not JSON, of another format, incomplete, or something in it of another shape.
    """
    try:
        card = json.loads(read_bytes(path, MAX_CARD_BYTES))
    except ValueError as error:
        raise UsageError(f"{path}: not a card ({error}), expected JSON") from None
    if not isinstance(card, dict) or card.get("format") != FORMAT:
        found = card.get("format") if isinstance(card, dict) else type(card).__name__
        raise UsageError(f"{path}: card format {found!r}, expected {FORMAT}")
    missing = [name for name in FIELDS if name not in card]
    if missing:
        raise UsageError(f"{path}: card lacks {', '.join(missing)}, expected {', '.join(FIELDS)}")
    wrong = card_error(card)
    if wrong:
        raise UsageError(f"{path}: card's {wrong}")
    return card


def write_card(path: Path, card: Card) -> None:
    """Write a card so that people can read it and a difference shows what changed."""
    path.write_text(_dumped(card) + "\n")


def _dumped(value: Any, indent: str = "") -> str:
    """JSON that breaks lines between members, but keeps lists and tables of bare values on one line."""
    inner = indent + " "
    if isinstance(value, dict) and any(isinstance(item, dict | list) for item in value.values()):
        rows = [f"{inner}{json.dumps(key)}: {_dumped(item, inner)}" for key, item in value.items()]
        return "{\n" + ",\n".join(rows) + f"\n{indent}}}"
    if isinstance(value, list) and any(isinstance(item, dict | list) for item in value):
        return "[\n" + ",\n".join(inner + _dumped(item, inner) for item in value) + f"\n{indent}]"
    return json.dumps(value, ensure_ascii=False)
