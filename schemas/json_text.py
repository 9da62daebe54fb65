"""Reads JSON objects from outside, such as a recording's provenance."""

from __future__ import annotations

import json
from typing import Any

from tailor.schemas.errors import Rejected


def table_of(text: str) -> dict[str, Any] | Rejected:
    """The JSON object in a text; a Rejected for any other text, including endless nesting."""
    try:
        value = json.loads(text)
    except (ValueError, RecursionError) as error:
        return Rejected(f"no JSON: {str(error)[:80]}")
    return value if isinstance(value, dict) else Rejected("no JSON object")
