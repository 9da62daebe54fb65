"""Runs the tests that should see each mutant, and fails if one survives: `make test-mutants`.

The tests of all mutants must pass first, without any.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict
from fnmatch import fnmatch
from pathlib import Path
from queue import SimpleQueue

from rich.console import Console
from rich.markup import escape
from rich.progress import Progress
from rich.table import Column, Table

from tests.mutants.mutant import ROOT, Mutant, problems, read_mutants
from tests.mutants.tree import Outcome, Tree, copied

WORKERS = 2
LIMIT_S = 120.0  # for the tests of one mutant
UNMUTATED_LIMIT_S = 600.0  # for all tests, once


def main(arguments: Sequence[str] | None = None) -> int:
    """0 if the tests killed every mutant, 1 if not, 2 if the list does not fit the code."""
    options = _options(arguments)
    mutants = [m for m in read_mutants() if not options.only or any(fnmatch(m.name, name) for name in options.only)]
    found = problems(mutants) if mutants else ["no mutant has such a name"]
    if found:
        print(*found, sep="\n", file=sys.stderr)
        return 2
    if options.list:
        print(*(f"{mutant.name}  {mutant.file}" for mutant in mutants), sep="\n")
        return 0
    console = Console(stderr=options.json, width=None if sys.stderr.isatty() else 140)
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        first = copied(ROOT, Path(folder) / "0")
        unmutated = first.run(_tests(mutants), UNMUTATED_LIMIT_S)
        if unmutated.status != "survived":
            console.print(f"without a mutant: {unmutated.status}: {unmutated.by}", markup=False)
            return 1
        trees = [first, *(first.copy(Path(folder) / str(number)) for number in range(1, options.workers))]
        outcomes = _run_all(mutants, trees, console)
    _print(outcomes, mutants, options.json, console)
    return 0 if all(outcome.status == "killed" for outcome in outcomes.values()) else 1


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="make test-mutants", description=__doc__)
    parser.add_argument("--only", metavar="NAME", nargs="+", help="these mutants; a name may contain * and ?")
    parser.add_argument("--list", action="store_true", help="list the mutants and run nothing")
    parser.add_argument("--json", action="store_true", help="print the outcomes as JSON")
    parser.add_argument("--workers", type=int, default=WORKERS, help=f"tests at a time (default {WORKERS})")
    return parser.parse_args(arguments)


def _tests(mutants: Sequence[Mutant]) -> list[str]:
    """Tests of all mutants, each once; a test whose whole file is in the list is left out."""
    tests = {test for mutant in mutants for test in mutant.tests}
    return sorted(test for test in tests if "::" not in test or test.split("::")[0] not in tests)


def _run_all(mutants: Sequence[Mutant], trees: Sequence[Tree], console: Console) -> dict[str, Outcome]:
    """Outcome of each mutant by name."""
    free: SimpleQueue[Tree] = SimpleQueue()
    for tree in trees:
        free.put(tree)

    def run(mutant: Mutant) -> Outcome:
        tree = free.get()
        try:
            with tree.mutated(mutant):
                return tree.run(mutant.tests, LIMIT_S)
        finally:
            free.put(tree)

    outcomes: dict[str, Outcome] = {}
    with Progress(console=console) as progress, ThreadPoolExecutor(len(trees)) as pool:
        task = progress.add_task("mutants", total=len(mutants))
        started = {pool.submit(run, mutant): mutant.name for mutant in mutants}
        try:
            for done in as_completed(started):
                outcome = outcomes[started[done]] = done.result()
                if outcome.status != "killed" or not console.is_terminal:  # a log has no progress bar
                    line = f"{started[done]}: {outcome.status}: {outcome.by.strip()}"
                    progress.print(line, markup=False, highlight=False, soft_wrap=True)
                progress.advance(task)
        except BaseException:  # e.g. Ctrl-C: do not run the rest
            pool.shutdown(cancel_futures=True)
            raise
    return outcomes


def _rows(outcomes: dict[str, Outcome], mutants: Sequence[Mutant]) -> Iterator[tuple[Mutant, Outcome]]:
    return ((mutant, outcomes[mutant.name]) for mutant in mutants)


def _print(outcomes: dict[str, Outcome], mutants: Sequence[Mutant], as_json: bool, console: Console) -> None:
    if as_json:
        rows = [{"mutant": m.name, "file": m.file, **asdict(outcome)} for m, outcome in _rows(outcomes, mutants)]
        print(json.dumps(rows, indent=1))
        return
    table = Table(Column("mutant", no_wrap=True), Column("killed by", overflow="fold"), "s", box=None)
    for mutant, outcome in _rows(outcomes, mutants):
        by = outcome.by.rpartition("::")[2] if outcome.status == "killed" else outcome.status.upper()
        table.add_row(mutant.name, escape(by), f"{outcome.seconds:.1f}")
    console.print(table)
    killed = sum(outcome.status == "killed" for outcome in outcomes.values())
    console.print(f"{killed} of {len(mutants)} mutants killed", highlight=False)


if __name__ == "__main__":
    sys.exit(main())
