"""Settings of refinement for the runs of an evaluation, as flags: what another price or limit of risk would cost."""

from __future__ import annotations

import argparse
import tomllib
from typing import Any

from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.errors import UsageError
from tailor.schemas.settings import from_table

FLAG = "--refinement"


def configure_settings(parser: argparse.ArgumentParser) -> None:
    """Declare `--refinement`."""
    parser.add_argument(FLAG, nargs="+", default=[], metavar="KEY=VALUE",
                        help="settings of [executive.refinement] for greedy and refined runs, e.g. risk_cost_s=20 "
                        "(default: those of docs/refinement.md)")  # fmt: skip


def settings_from(words: list[str]) -> RefinementSettings:
    """Settings of greedy and refined runs.

    Args:
      words: KEY=VALUE, each a line of the table [executive.refinement].

    Raises:
      UsageError: An unknown key, a value of another type or out of range, a key that is named twice, or the horizon.
    """
    table: dict[str, Any] = {}
    for word in words:
        key, _, value = word.partition("=")
        if key == "horizon":
            raise UsageError(f"{FLAG} {word}: the horizon of greedy runs is 1, of refined ones --horizon H")
        if key in table:
            raise UsageError(f"{FLAG}: '{key}' is there twice, expected once")
        try:
            table[key] = tomllib.loads(f"value = {value}")["value"]
        except tomllib.TOMLDecodeError:
            raise UsageError(f"{FLAG} '{word}', expected KEY=VALUE, such as risk_cost_s=20") from None
    return from_table(RefinementSettings, table, FLAG)


def settings_remark(words: list[str]) -> list[str]:
    """A line for the report of runs with other settings than those that ship."""
    return [f"settings of refinement: {', '.join(words)}"] if words else []
