"""The planner on the project's own problems, beside the original VHPOP's counts."""

from __future__ import annotations

from rich.console import Console
from rich.table import Table

from bench.planning import bytes_per_plan, rows


def run(console: Console, quick: bool) -> None:
    """Print the table."""
    columns = ("problem", "steps", "generated", "visited", "cpu_ms", "plans_per_s", "original_generated",
               "original_visited")  # fmt: skip
    table = Table(
        *(column.replace("_", " ") for column in columns), title="planning, CPU time with parsing and grounding"
    )
    for row in rows(quick):
        table.add_row(*(str(row[column]) for column in columns))
    console.print(table)
    console.print(f"memory: {bytes_per_plan():.0f} bytes per generated plan")
