"""External planners by name: those that come as Python packages run in a process of this Python.

`kairos` is kairos-planner's first plan, `kairos:5` its best one after five seconds; `up:NAME` is the engine NAME of
unified-planning.
"""

from __future__ import annotations

import math
import sys
from importlib.util import find_spec

from tailor.schemas.errors import UsageError

KAIROS, UNIFIED = "kairos", "up"


def kairos_installed() -> bool:
    """Whether the package kairos-planner is installed."""
    return find_spec("kairos") is not None


def named_planner(command: str) -> list[str] | None:
    """Program and arguments of a planner by name.

    Args:
      command: A command that may be "kairos", "kairos:SECONDS" or "up:ENGINE".

    Returns:
      The words of its command; None if it is no such name.

    Raises:
      UsageError: The package is not installed, or what follows the colon is wrong.
    """
    name, colon, detail = command.strip().partition(":")
    if name == KAIROS and " " not in command.strip():
        if not kairos_installed():
            raise _missing(command, "kairos-planner", KAIROS)
        return _module("kairos_planner", str(_seconds(command, detail) if colon else 0.0))
    if name == UNIFIED and colon:
        if not detail or " " in detail:
            raise UsageError(f"planner '{command}': expected up:ENGINE, e.g. up:pyperplan")
        if find_spec("unified_planning") is None:
            raise _missing(command, "unified-planning", UNIFIED)
        return _module("unified_planner", detail)
    return None


def _module(name: str, argument: str) -> list[str]:
    return [sys.executable, "-P", "-m", f"tailor.runtime.planners.{name}", argument]


def _seconds(command: str, text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if not 0 < seconds < math.inf:
        raise UsageError(f"planner '{command}': expected kairos:SECONDS with seconds above 0, e.g. kairos:5")
    return seconds


def _missing(command: str, package: str, extra: str) -> UsageError:
    return UsageError(
        f"planner '{command}': the package {package} is not installed, install it with: pip install 'tailor[{extra}]'"
    )
