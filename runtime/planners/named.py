"""External planners by name: those that come as Python packages run in a process of this Python.

`kairos` is kairos-planner's first plan, `kairos:5` its best one after five seconds, `kairos:5:0.1` that with dependent
events 0.1 s apart; `up:NAME` is the engine NAME of unified-planning.
"""

from __future__ import annotations

import math
import subprocess
import sys
from importlib.util import find_spec

from tailor.schemas.errors import UsageError

KAIROS, UNIFIED = "kairos", "up"
MIN_LIMIT_S = 0.001
CHECK_S = 30.0  # for importing unified-planning and an engine of it; takes about a second
# plans refined by the built-in search before kairos-planner plans, 0.05 to 0.1 s: short problems keep their plans
DURATIVE_HEAD_START = 250


def kairos_installed() -> bool:
    """Whether the package kairos-planner is installed."""
    return find_spec("kairos") is not None


def named_planner(command: str) -> list[str] | None:
    """Program and arguments of a planner by name.

    Args:
      command: A command that may be "kairos", "kairos:SECONDS", "kairos:SECONDS:TICK" or "up:ENGINE".

    Returns:
      The words of its command; None if it is no such name.

    Raises:
      UsageError: The package is not installed, or what follows the colon is wrong.
    """
    name, colon, detail = command.strip().partition(":")
    if name == KAIROS and " " not in command.strip():
        if not kairos_installed():
            raise _missing(command, "kairos-planner", KAIROS)
        seconds, separated, tick = detail.partition(":")
        return _module(
            "kairos_planner",
            str(_seconds(command, seconds) if colon and (seconds or not separated) else 0.0),
            str(_seconds(command, tick) if separated else 0.0),
        )
    if name == UNIFIED and colon:
        if not detail or " " in detail:
            raise UsageError(f"planner '{command}': expected up:ENGINE, e.g. up:pyperplan")
        if find_spec("unified_planning") is None:
            raise _missing(command, "unified-planning", UNIFIED)
        return _module("unified_planner", detail)
    return None


def check_engine(command: str) -> None:
    """Check that the engine of "up:ENGINE" exists and plans; other commands pass.

    A process of its own looks, for a second: unified-planning and its engines are not imported here.

    Raises:
      UsageError: There is no such engine, or it is no planner, or unified-planning cannot be imported in time.
    """
    words = named_planner(command) if command.strip().startswith(f"{UNIFIED}:") else None
    if words is None:
        return
    try:
        looked = subprocess.run(
            words, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL, timeout=CHECK_S
        )
    except subprocess.TimeoutExpired as error:
        raise UsageError(f"planner '{command}': not loaded within {CHECK_S:g} s") from error
    if looked.returncode == 0:
        return
    reason = looked.stdout.strip()
    if not reason:
        reason = f"unified-planning does not start: {''.join(looked.stderr.strip().splitlines()[-1:])}"
    raise UsageError(f"planner '{command}': {reason}")


def kairos_command(limit_s: float, tick_s: float) -> str:
    """The command of kairos-planner with a time limit (infinite: its first plan) and a tick, both in seconds."""
    return f"{KAIROS}:{'' if math.isinf(limit_s) else max(limit_s, MIN_LIMIT_S)}:{tick_s}"


def _module(name: str, *arguments: str) -> list[str]:
    return [sys.executable, "-P", "-m", f"tailor.runtime.planners.{name}", *arguments]


def _seconds(command: str, text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if not 0 < seconds < math.inf:
        raise UsageError(f"planner '{command}': expected kairos:SECONDS or kairos:SECONDS:TICK, above 0, e.g. kairos:5")
    return seconds


def _missing(command: str, package: str, extra: str) -> UsageError:
    return UsageError(
        f"planner '{command}': the package {package} is not installed, install it with: pip install 'tailor[{extra}]'"
    )
