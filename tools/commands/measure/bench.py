"""Measure speed, memory and timing: all benchmarks, or those named."""

from __future__ import annotations

import argparse
import importlib
import sys

from rich.console import Console

from tailor.schemas.errors import UsageError
from tailor.tools.benchmarks.no_measurement import NoMeasurement

BENCHMARKS = {
    "ticks": "lateness and work of live ticks, idle and beside CPU burners; delay from percept to command",
    "planning": "steps, generated and visited plans and CPU time of each problem",
    "refine": "gap to the best known value over CPU time for each solver; time of proofs",
    "models": "time of a prediction and of a fit",
    "gather": "simulated seconds for each wall second",
    "memory": "resident memory of each process, page faults of the loop",
    "recording": "CPU share of the recorder, loss, lateness of a replay, speed of verify",
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor bench`."""
    rows = "; ".join(f"{name}: {text}" for name, text in BENCHMARKS.items())
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"benchmarks to run (default: all). {rows}")
    parser.add_argument("--quick", action="store_true", help="shorter runs with a larger variance")


def run(arguments: argparse.Namespace) -> int:
    """Run each benchmark; 0 if all have measured something, otherwise 1.

    Raises:
      UsageError: An unknown name.
    """
    unknown = sorted(set(arguments.names) - BENCHMARKS.keys())
    if unknown:
        raise UsageError(f"no benchmark {', '.join(unknown)}, expected some of: {', '.join(BENCHMARKS)}")
    console, code = Console(), 0
    for name in arguments.names or BENCHMARKS:
        console.rule(name)
        module = importlib.import_module(f"tailor.tools.benchmarks.{name}")
        try:
            module.run(console, arguments.quick)
        except NoMeasurement as failure:
            print(f"tailor bench {name}: nothing measured: {failure}", file=sys.stderr)
            code = 1
    return code
