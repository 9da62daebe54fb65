"""Model cards: identity, provenance, test results and golden examples of a model.

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
from tailor.schemas.parsed_files import json_value

FORMAT = 1
# "clearance" is success beside one object of the action's context; "duration_beside" is durations beside any of them
KINDS = ("duration", "success", "clearance", "energy", "duration_beside")
SUCCESS_KINDS = ("success", "clearance")
UNITS = {"duration": "s", "duration_beside": "s", "energy": "J"}  # of the predictions; a probability has none
MAX_CARD_BYTES = 1 << 20  # ours are some 20 kB
MAX_MODEL_BYTES = 64 << 20  # ours are well below 1 MB
# required entries; docs/learning.md explains each
FIELDS = (
    "robot", "action", "kind", "features", "arguments", "outputs", "output_range", "episodes", "learner", "test",
    "sha256", "golden", "versions", "command",
)  # fmt: skip

Card = Mapping[str, Any]


def card_path(model: Path) -> Path:
    """Path of the card of an ONNX file."""
    return model.with_name(f"{model.stem}.card.json")


def sha256_of(content: bytes) -> str:
    """SHA-256 as 64 hexadecimal digits."""
    return hashlib.sha256(content).hexdigest()


def identity(card: Card) -> dict[str, str]:
    """Entries of the card that the ONNX file repeats in its metadata."""
    names = " ".join(argument["name"] for argument in card["arguments"])
    return {**{key: str(card[key]) for key in ("robot", "action", "kind", "features")}, "arguments": names}


def read_bytes(path: Path, limit: int) -> bytes:
    """Content of a file of at most `limit` bytes.

    Raises:
      UsageError: The file is missing, not a regular file, or too large.
    """
    if not path.is_file():
        raise UsageError(f"{path}: no such file, expected an action model and its card (`tailor train` writes them)")
    size = path.stat().st_size
    if size > limit:
        raise UsageError(f"{path}: has {size} bytes, expected at most {limit}")
    return path.read_bytes()


def read_card(path: Path) -> dict[str, Any]:
    """Read a card and check its entries.

    Raises:
      UsageError: The file is missing, not JSON, of another format, incomplete, or an entry has another shape.
    """
    try:
        card = json_value(read_bytes(path, MAX_CARD_BYTES).decode())
    except ValueError as error:
        raise UsageError(f"{path}: not a card ({error}), expected JSON") from None
    if not isinstance(card, dict) or card.get("format") != FORMAT:
        actual = card.get("format") if isinstance(card, dict) else type(card).__name__
        raise UsageError(f"{path}: card format {actual!r}, expected {FORMAT}")
    missing = [name for name in FIELDS if name not in card]
    if missing:
        raise UsageError(f"{path}: card lacks {', '.join(missing)}, expected {', '.join(FIELDS)}")
    problem = card_error(card)
    if problem:
        raise UsageError(f"{path}: card's {problem}")
    return card


def write_card(path: Path, card: Card) -> None:
    """Write a card as JSON with one entry per line, for readable diffs."""
    # what is no UTF-8, such as the name of a recording, is escaped as JSON does
    path.write_text(_dumped(card) + "\n", encoding="utf-8", errors="backslashreplace")


def _dumped(value: Any, indent: str = "") -> str:
    """JSON with line breaks between nested entries; lists and objects of bare values stay on one line."""
    inner = indent + " "
    if isinstance(value, dict) and any(isinstance(item, dict | list) for item in value.values()):
        rows = [f"{inner}{json.dumps(key)}: {_dumped(item, inner)}" for key, item in value.items()]
        return "{\n" + ",\n".join(rows) + f"\n{indent}}}"
    if isinstance(value, list) and any(isinstance(item, dict | list) for item in value):
        return "[\n" + ",\n".join(inner + _dumped(item, inner) for item in value) + f"\n{indent}]"
    return json.dumps(value, ensure_ascii=False)
