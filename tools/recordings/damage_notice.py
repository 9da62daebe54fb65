"""States that a recording is damaged, wherever it is shown: its readable part must not pass for the whole run."""

from __future__ import annotations

import sys
from pathlib import Path

from tailor.runtime.recordings.mcap.scan import DamageReport
from tailor.tools.cli.plain_text import plain


def notice(path: Path, damage: DamageReport) -> str:
    """One line about the damage of a recording that was read to its end; empty for an undamaged one."""
    text = damage.text()
    return f"{plain(path.name)} is damaged: {text}; only its readable messages are shown" if text else ""


def warn(path: Path, damage: DamageReport) -> None:
    """Print the notice, if there is one, beside the output proper."""
    if line := notice(path, damage):
        print(line, file=sys.stderr)
