"""Feed the inputs of a recording through today's core and compare every output bit for bit.

With --output, the outputs of today's core in the file's first run are written as a recording; `tailor compare` compares
the two. Most of the time goes into the proofs of optimality gaps; --without-proofs omits them.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import sys
from pathlib import Path
from typing import Any

from tailor.executive.composition import rebuild_context
from tailor.runtime.platform_fingerprint import platform_fingerprint
from tailor.runtime.recordings.new_file import new_file
from tailor.schemas.errors import UsageError
from tailor.schemas.installed.core_source import core_source
from tailor.tools.cli.plain_text import plain
from tailor.tools.lockstep.blame import blamed_on_run
from tailor.tools.recordings.damage_notice import warn
from tailor.tools.recordings.executive_run import RecordedRun
from tailor.tools.recordings.recorded_run import RecordedRuns
from tailor.tools.recordings.recorded_source import source_entry
from tailor.tools.recordings.verification import Verdict, verdict_text, verify


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor verify`."""
    parser.add_argument("recording", type=Path, help="MCAP file of `tailor record` or `tailor up --record`")
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument(
        "--without-proofs", action="store_true", help="neither compute nor compare optimality gaps (gap_pct); faster"
    )
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE", help="write the outputs of today's core as a recording"
    )


def run(arguments: argparse.Namespace) -> int:
    """0 if all runs in the file are equal, 1 if one differs, 2 if the recording lacks a tick, an input or an output.

    With --output, which takes the proofs along, that concerns the first run alone.
    """
    if arguments.output is not None and arguments.without_proofs:
        raise UsageError("--output writes all outputs of today's core, expected it without --without-proofs")
    runs = RecordedRuns(arguments.recording)
    warn(arguments.recording, runs.damage)
    faults: list[str] = []
    if arguments.output is None:
        verdicts, faults = _verify_each(runs, not arguments.without_proofs)
    else:
        verdicts = [_verify_and_write(arguments.output, runs)]
    if arguments.json:
        print(json.dumps([dataclasses.asdict(verdict) for verdict in verdicts], indent=1))
    else:
        for verdict in verdicts:
            print(verdict_text(verdict))
    for fault in faults:
        print(f"tailor verify: {plain(fault)}", file=sys.stderr)
    if any(verdict.difference for verdict in verdicts):
        return 1
    return 2 if faults or any(verdict.ends or verdict.lost for verdict in verdicts) else 0


def _verify_each(runs: RecordedRuns, proofs: bool) -> tuple[list[Verdict], list[str]]:
    """Verdicts on all runs, and of those that cannot be verified here the reasons, such as a robot unknown here.

    Raises:
      UsageError: The only run of the file cannot be verified.
    """
    verdicts, faults = [], []
    for run in runs.runs:
        try:
            verdicts.append(_verified(runs, run, proofs))
        except UsageError as error:
            if len(runs.runs) == 1:
                raise
            faults.append(f"executive {run.sender[:8]}: {error}")
    return verdicts, faults


def _verified(runs: RecordedRuns, run: RecordedRun, proofs: bool) -> Verdict:
    """The verdict on the ticks before one that is missing, e.g. since an executive or the bus had stood still."""
    context = rebuild_context(run.provenance)
    with blamed_on_run(context.domain.name):
        return verify(runs, run, context, proofs=proofs, partly=True)


def _verify_and_write(path: Path, runs: RecordedRuns) -> Verdict:
    from tailor.tools.lockstep.run_writer import RunWriter  # late: it loads the live shell, and with it the bus

    run = runs.runs[0]
    context = rebuild_context(run.provenance)
    with new_file(path):
        writer = RunWriter(path, context, {**run.provenance, **_made_here(context.domain.name)})
        try:
            with blamed_on_run(context.domain.name):
                return verify(runs, run, context, writer)
        finally:
            writer.close()


def _made_here(domain: str) -> dict[str, Any]:
    return {"machine": platform_fingerprint(), "source": source_entry(core_source(domain))}
