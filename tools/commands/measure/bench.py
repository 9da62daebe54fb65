"""Measure speed, memory and punctuality: all benchmarks one after another, or those that are named."""

from __future__ import annotations

import argparse
import importlib

from rich.console import Console

from tailor.schemas.errors import UsageError

BENCHMARKS = {
    "ticks": "lateness and work of live ticks, idle and with CPU burners; time from percept to command",
    "planning": "problem by problem: steps, generated, visited, CPU time",
    "refine": "gap to the best known against milliseconds, solver by solver",
    "models": "microseconds of a prediction, seconds of a fit",
    "gather": "simulated seconds per wall second",
    "recording": "recorder's CPU share, replay's lateness, verify's speed",
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor bench`."""
    rows = "; ".join(f"{name}: {text}" for name, text in BENCHMARKS.items())
    parser.add_argument("names", nargs="*", metavar="NAME", help=rows)
    parser.add_argument("--quick", action="store_true", help="shorter runs, wider scatter")


def run(arguments: argparse.Namespace) -> int:
    """Run each; 0 when all ran."""
    unknown = sorted(set(arguments.names) - BENCHMARKS.keys())
    if unknown:
        raise UsageError(f"no benchmark {', '.join(unknown)}, expected some of: {', '.join(BENCHMARKS)}")
    console = Console()
    for name in arguments.names or BENCHMARKS:
        console.rule(name)
        module = importlib.import_module(f"tailor.tools.benchmarks.{name}")
        module.run(console, arguments.quick)
    return 0
