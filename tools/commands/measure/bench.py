"""Measure speed, memory and timing: all benchmarks, or those named."""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from tailor.schemas.errors import UsageError
from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.cli.extras import BENCHMARKS_NEED, require
from tailor.tools.cli.given_options import given_options
from tailor.tools.cli.number_checks import add_count
from tailor.tools.cli.output_files import check_output, check_writable
from tailor.tools.cli.terminal import table_console

BENCHMARKS = {
    "ticks": "lateness and work of live ticks, idle and beside CPU burners; delay from percept to command",
    "driver": "delay from percept to command through `tailor driver`, and without a driver",
    "planning": "steps, counts and CPU time of each problem; solved by configuration; anytime plans; share of a tick",
    "refine": "gap to the best known value over CPU time for each solver; time of proofs",
    "models": "time of a prediction and of a fit",
    "gather": "simulated seconds for each wall second",
    "memory": "resident memory of each process, page faults of the loop",
    "recording": "CPU share of the recorder, loss, lateness of a replay, speed of verify",
}

# of `planning`, after its table
PLANNERS = tuple(
    f"planners.{name}" for name in ("improvement", "tours", "balls", "cups", "tick_share", "configurations")
)
SCALE = ("planning_scale", "execution.durative_plans", "execution.long_plans")
SOAK, GROWTH, CLUSTER = "soak", "growth", "cluster"
ROOMS = {"refine": "refinement.refine", GROWTH: "growth.growth", CLUSTER: "scaling.cluster"}
ON_REQUEST = {
    SOAK: "whole systems under one random fault a minute: invariants, memory; only if named",
    GROWTH: "curves: how costs grow with plans, free parameters, episodes, recordings, opponents; only if named",
    CLUSTER: "simulated speed-up of gathering by 2 to 64 workers, from measured parts and overheads; only if named",
}
USED_BY = {  # option -> benchmarks that use it
    "quick": (*BENCHMARKS, GROWTH, CLUSTER),
    "scale": ("planning",),
    "output": (SOAK, GROWTH),
    **dict.fromkeys(("minutes", "seed", "every", "only", "json"), (SOAK,)),
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor bench`."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    rows = (f"  {name:10s} {text}" for name, text in {**BENCHMARKS, **ON_REQUEST}.items())
    parser.epilog = "\n".join(["benchmarks:", *rows])
    unnamed = f"all but {', '.join(ON_REQUEST)}"
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"benchmarks to run, see below (default: {unnamed})")
    parser.add_argument("--quick", action="store_true", help="shorter runs with a larger variance")
    parser.add_argument("--scale", action="store_true", help="planning: times of planning and of ticks as steps grow")
    add_count(parser, "--minutes", 1, 3, "soak: duration")
    add_count(parser, "--seed", 0, 0, "soak: random seed")
    add_count(parser, "--every", 10, 60, "soak: time between faults", metavar="S")
    parser.add_argument("--only", metavar="TEXT", default="", help="soak: only faults whose name contains this")
    parser.add_argument(
        "--output", type=Path, metavar="FILE", help="soak, growth: file (default out/soak.json, out/growth.json)"
    )
    parser.add_argument("--json", action="store_true", help="soak: print the results as JSON")


def run(arguments: argparse.Namespace) -> int:
    """Run each benchmark; 0 if all have measured something and no invariant of a soak was violated, otherwise 1.

    Raises:
      UsageError: An unknown name, an option that none of the benchmarks uses, a file that cannot be written, or a
        missing extra.
    """
    known = (*BENCHMARKS, *ON_REQUEST)
    unknown = sorted(set(arguments.names) - set(known))
    if unknown:
        raise UsageError(f"no benchmark {', '.join(unknown)}, expected some of: {', '.join(known)}")
    names = arguments.names or list(BENCHMARKS)
    _refuse_ignored(arguments, names)
    _check_output(arguments, names)
    require(*dict.fromkeys(extra for name in names for extra in BENCHMARKS_NEED.get(name, ())))
    console, code = table_console(), 0
    for name in names:
        if not arguments.json:
            console.rule(name)
        try:
            passed = _run_one(name, console, arguments)
        except NoMeasurement as failure:
            print(f"tailor bench {name}: nothing measured: {failure}", file=sys.stderr)
            passed = False
        code = code if passed else 1
    return code


def _refuse_ignored(arguments: argparse.Namespace, names: Sequence[str]) -> None:
    """Raises UsageError for options that none of the benchmarks `names` uses."""
    for option in given_options(configure, arguments, {option: option for option in USED_BY}):
        if not set(USED_BY[option]) & set(names):
            raise UsageError(f"--{option}: not used by {', '.join(names)}, only by {', '.join(USED_BY[option])}")


def _check_output(arguments: argparse.Namespace, names: Sequence[str]) -> None:
    """Raises UsageError if the results could not be told apart, or not be written after minutes to hours of work."""
    writing = [name for name in (SOAK, GROWTH) if name in names]
    if arguments.json and set(names) != {SOAK}:
        raise UsageError(f"--json: of soak alone, found {', '.join(names)}, which print tables")
    if arguments.output is not None and len(writing) > 1:
        raise UsageError(f"--output {arguments.output}: of one benchmark, found {', '.join(writing)}")
    for name in writing:
        output = _output_of(name, arguments)
        check_output("--output", output, (".json",))
        check_writable("--output", output)


def _output_of(name: str, arguments: argparse.Namespace) -> Path:
    return arguments.output or Path(f"out/{name}.json")


def _run_one(name: str, console: Console, arguments: argparse.Namespace) -> bool:
    if name == "planning" and arguments.scale:
        for module_name in SCALE:
            importlib.import_module(f"tailor.tools.benchmarks.{module_name}").run(console, arguments.quick)
        return True
    module = importlib.import_module(f"tailor.tools.benchmarks.{ROOMS.get(name, name)}")
    output = _output_of(name, arguments)
    if name == GROWTH:
        module.run(console, arguments.quick, output)
        return True
    if name == SOAK:
        options = (arguments.minutes, arguments.seed, arguments.every, arguments.only, output, arguments.json)
        return bool(module.run(console, module.Options(*options)))
    module.run(console, arguments.quick)
    for more in PLANNERS if name == "planning" else ():
        importlib.import_module(f"tailor.tools.benchmarks.{more}").run(console, arguments.quick)
    return True
