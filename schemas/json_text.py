"""Reads JSON objects that come from outside, such as a recording's provenance."""

from __future__ import annotations

import json
from typing import Any

from tailor.schemas.errors import Rejected


def table_of(text: str) -> dict[str, Any] | Rejected:
    """The object that a text holds, whatever it holds: nesting without end is refused like any other text."""
    try:
        found = json.loads(text)
    except (ValueError, RecursionError) as error:
        return Rejected(f"no JSON: {str(error)[:80]}")
    return found if isinstance(found, dict) else Rejected("no JSON object")
