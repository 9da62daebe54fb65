"""The planner's benchmark alone: `python -m bench.planning [--quick] [--json]`; see tools/benchmarks/planning.py."""

from __future__ import annotations

import argparse
import json

from rich.console import Console

from tools.benchmarks.planning import bytes_per_plan, rows, run

__all__ = ["bytes_per_plan", "main", "rows"]


def main() -> None:
    """Print the table, or the rows as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="fewer runs a problem")
    parser.add_argument("--json", action="store_true", help="rows as JSON")
    arguments = parser.parse_args()
    if arguments.json:
        print(json.dumps(rows(arguments.quick), indent=1))
    else:
        run(Console(), arguments.quick)


if __name__ == "__main__":
    main()
