"""What the recordings of a soak hold, also those whose recorder was killed."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.errors import UsageError


def recording_rows(paths: Iterable[Path]) -> list[dict[str, Any]]:
    """One row for each file: messages, seconds from the first to the last, and the error if it cannot be read.

    A system that was ended while it started has none.
    """
    return [_row(path) for path in paths if path.exists()]


def _row(path: Path) -> dict[str, Any]:
    count, first_ns, last_ns = 0, 0, 0
    try:
        for message in open_recording(path).messages():
            count += 1
            first_ns, last_ns = first_ns or message.log_ns, message.log_ns
    except UsageError as error:
        return {"file": path.name, "messages": count, "seconds": 0.0, "error": str(error)}
    return {"file": path.name, "messages": count, "seconds": round((last_ns - first_ns) / 1e9, 1), "error": ""}
