"""Calls a command of Tailor whose answer a benchmark reads; one that gives none is no measurement."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Sequence
from typing import Any

from tailor.tools.benchmarks.no_measurement import NoMeasurement

LIMIT_S = 600.0  # of a replay or a verification, which take seconds


def answer(name: str, command: Sequence[str]) -> tuple[Any, int]:
    """What a command prints as JSON, and its exit code.

    Raises:
      NoMeasurement: It was refused, or has not ended after LIMIT_S.
    """
    try:
        completed = subprocess.run(command, capture_output=True, text=True, check=False, timeout=LIMIT_S)
        return json.loads(completed.stdout), completed.returncode
    except subprocess.TimeoutExpired as error:
        raise NoMeasurement(f"{name} has not ended after {LIMIT_S:.0f} s") from error
    except json.JSONDecodeError as error:
        reason = completed.stderr.strip()[-200:]
        raise NoMeasurement(f"{name} has ended with code {completed.returncode}: {reason}") from error
