"""Reproduce the paper's tables and figures, beside the values of the paper."""

from __future__ import annotations

import argparse
import itertools
import sys
from typing import Any

from tailor.schemas.errors import UsageError
from tailor.tools.cli.output_files import check_writable
from tailor.tools.evaluations.catalogue import ALL, EVALUATIONS, Chosen, chosen_of, domains_of, names_and_flags
from tailor.tools.evaluations.pages.finished import exit_code_of, flags_of, forget, note
from tailor.tools.evaluations.pages.overview import write_overview
from tailor.tools.evaluations.seeds import seeds_of
from tailor.tools.launch.checks.package_check import check_package
from tailor.tools.lockstep.blame import blamed_on_run
from tailor.tools.lockstep.sampler_check import check_sampler
from tailor.tools.parallel.cluster import working_on
from tailor.tools.parallel.software import Work

RESUME = "--resume"
MISSED = 1  # exit code: the results of an evaluation are not what it tests for
STOPPED = 128  # exit codes above it: a signal ended an evaluation
EPILOG = """
`tailor evaluate NAME --help` lists the flags of one evaluation. With `all`, each takes the flags that it has.
--resume: skip evaluations with a page of this source, these models and these flags in the report's folder; their exit
codes count. Finished episodes are kept in any case. The exit code is 1 if the results miss an evaluation's criterion
(docs/evaluating.md), e.g. since too few starts prove nothing.

examples:
  tailor evaluate refinement --domain soccer --scenario approach-dribble --json
  tailor evaluate table3 table4 figure16 --domain soccer --report out/report
  tailor evaluate all --report out/report --resume
  tailor evaluate table3 --on tcp://lab-7:8786 --report out/report   (on a cluster: docs/cluster.md)
"""


HELP_OF_ALL = """\
usage: tailor evaluate all [--report DIR [--resume]] [...]

Run {names}.
Each takes the flags that it has; `tailor evaluate NAME --help` lists them.
With --domain, those of another domain are left out."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments; each evaluation declares its own flags."""
    width = max(map(len, EVALUATIONS))
    rows = [f"  {name:<{width}}  {text}" for name, (_, text) in EVALUATIONS.items()]
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.usage = "tailor evaluate NAME [NAME ...] [--json] [--report DIR [--resume]] [...]"
    parser.epilog = "\n".join(["evaluations:", *rows, f"  {ALL:<{width}}  all of the paper's", EPILOG])
    parser.add_argument("words", nargs=argparse.REMAINDER, metavar="NAME", help="evaluations, then their flags")


def run(arguments: argparse.Namespace) -> int:
    """Run each evaluation; returns the maximum of their exit codes."""
    names, flags = names_and_flags(arguments.words)
    everything = ALL in arguments.words[:1]
    if everything and {"-h", "--help"} & set(flags):
        print(HELP_OF_ALL.format(names=", ".join(names)))
        return 0
    # raises on a wrong flag before anything runs
    chosen = chosen_of(names, [flag for flag in flags if flag != RESUME], everything)
    if RESUME in flags and chosen and chosen[0][2].report is None:
        raise UsageError(
            "--resume skips evaluations whose page is in the report's folder, expected --report DIR with it"
        )
    if chosen and (folder := chosen[0][2].report) is not None:  # all take the same flags
        check_writable("--report", folder / "index.html")  # not after hours
    for domain in {settings.domain for *_, settings in chosen if settings.domain}:
        check_package(domain)  # not in the midst of it, by a traceback
        check_sampler(domain)
    with working_on(chosen[0][2].on if chosen else None, _work_of(chosen)):
        return _run_all(chosen, RESUME in flags, everything)


def _work_of(chosen: list[Chosen]) -> Work:
    """Domains and models of the evaluations, all of which take the same flags."""
    named = [(settings.domain,) if settings.domain else domains_of(module) for _, module, settings in chosen]
    return Work(tuple(sorted(set(itertools.chain(*named)))), chosen[0][2].zoo if chosen else "")


def _run_all(chosen: list[Chosen], resume: bool, everything: bool) -> int:
    """Run each evaluation; returns the maximum of their exit codes."""
    code = 0
    for name, module, settings in chosen:
        if settings.report is None:
            done = _run_one(name, module, settings, everything)
        else:
            known = _known(name, module, settings) if resume else None
            done = _run_noted(name, module, settings, everything) if known is None else known
        if done > STOPPED:
            return done
        code = max(code, done)
    return code


def _known(name: str, module: Any, settings: argparse.Namespace) -> int | None:
    """Exit code of an evaluation whose page is in the report's folder, of the source, models and flags of now."""
    domain = settings.domain or domains_of(module)[0]
    return exit_code_of(settings.report, name, flags_of(settings), seeds_of(domain, settings).provenance)


def _run_noted(name: str, module: Any, settings: argparse.Namespace, everything: bool) -> int:
    """Run one evaluation that writes a page; a later --resume skips it unless it was stopped or could not run."""
    folder, flags = settings.report, flags_of(settings)  # before it runs: some fill in their defaults
    forget(folder, name)
    code = _run_one(name, module, settings, everything)
    if code <= MISSED:
        note(folder, name, flags, code)
    write_overview(folder, list(EVALUATIONS))
    return code


def _run_one(name: str, module: Any, settings: argparse.Namespace, everything: bool) -> int:
    """Run one evaluation; with `all`, a UsageError ends only this one (exit code 2)."""
    try:
        with blamed_on_run(settings.domain or domains_of(module)[0], parts_alone=True):
            code = int(module.run(settings))
    except UsageError as error:
        if not everything:
            raise
        print(f"tailor evaluate {name}: {error}", file=sys.stderr)
        return 2
    if code == MISSED:
        print(f"tailor evaluate {name}: the results miss its criterion, so the exit code is 1", file=sys.stderr)
    return code
