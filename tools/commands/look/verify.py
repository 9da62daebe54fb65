"""Feed a recording's inputs and granted checks through today's core and compare every output, bit for bit.

With --output, what today's core says is written as a recording of its own; `tailor compare` shows the two side by side.
Most of the time goes into proving how near every choice is to the optimum: --without-proofs leaves out that alone.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import time
from dataclasses import dataclass
from itertools import tee
from pathlib import Path
from typing import TYPE_CHECKING

from tailor.executive.composition import rebuild_context
from tailor.executive.core.context import Context
from tailor.executive.replay import replay
from tailor.runtime.gc_freeze import gc_frozen
from tailor.runtime.platform_fingerprint import contrast, platform_fingerprint, same_kind
from tailor.schemas.errors import UsageError
from tailor.tools.recordings.core_comparison import RunComparison, without_proofs
from tailor.tools.recordings.differences import ROUNDING, Difference
from tailor.tools.recordings.recorded_run import RecordedRun, RecordedRuns

if TYPE_CHECKING:
    from tailor.tools.lockstep.run_writer import RunWriter


@dataclass(frozen=True, slots=True)
class Verdict:
    """How a run compares: equal when `difference` is None."""

    sender: str
    ticks: int
    compared: int  # messages
    rounded: int  # of them, equal but for rounding; 0 unless the machine that recorded is of another kind
    difference: Difference | None
    machines: str  # what differs between the recording machine and this one
    left_out: str  # what on exec/tick was no tick of an executive, for people; empty: nothing
    took_s: float  # without what comes once a process: the file read, models loaded, readers of messages compiled

    @property
    def times_real_time(self) -> float:
        """Seconds of the run per second of verifying, at ten ticks a second."""
        return self.ticks / 10 / self.took_s


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor verify`."""
    parser.add_argument("recording", type=Path, help="an MCAP file of `tailor record` or `tailor up --record`")
    parser.add_argument("--json", action="store_true", help="print the verdicts as JSON")
    parser.add_argument(
        "--without-proofs", action="store_true", help="do not prove choices again, so do not compare gap_pct; faster"
    )
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE", help="write what today's core says, as a recording of its own"
    )


def run(arguments: argparse.Namespace) -> int:
    """0 when every run in the file is equal, 1 when one differs, 2 when the file cannot be verified."""
    runs = RecordedRuns(arguments.recording)
    if arguments.output is None:
        verdicts = [
            verify(runs, found, rebuild_context(found.provenance), proofs=not arguments.without_proofs)
            for found in runs.runs
        ]
    else:
        verdicts = [_verify_onto(arguments.output, runs)]
    if arguments.json:
        print(json.dumps([dataclasses.asdict(verdict) for verdict in verdicts], indent=1))
    else:
        for verdict in verdicts:
            print(told(verdict))
    return int(any(verdict.difference for verdict in verdicts))


def verify(
    runs: RecordedRuns, run: RecordedRun, context: Context, tape: RunWriter | None = None, proofs: bool = True
) -> Verdict:
    """Compare one run with what today's core makes of it, up to the first difference.

    Rounding is forgiven only if the recording comes from another kind of machine (see `platform_fingerprint`).

    Args:
      runs: The recording.
      run: One of its runs.
      context: What today's core is given, as `rebuild_context` makes it.
      tape: Where to write what it says; it then goes on to the end, whatever differs.
      proofs: Whether to prove choices again and compare how near to the optimum they are.
    """
    here, there = platform_fingerprint(), run.provenance.get("machine", {})
    comparison = RunComparison(run, context.domain.robot, same_kind(there, here), proofs)
    with gc_frozen():  # as live
        began = time.perf_counter()
        difference = _compared(comparison, runs, run, context if proofs else without_proofs(context), tape)
        took_s = time.perf_counter() - began
    return Verdict(
        run.sender,
        comparison.ticks,
        comparison.compared,
        comparison.rounded,
        difference,
        contrast(there, here),
        runs.left_out_text(),
        took_s,
    )


def _compared(
    comparison: RunComparison, runs: RecordedRuns, run: RecordedRun, context: Context, tape: RunWriter | None
) -> Difference | None:
    """The first difference."""
    difference = None
    ticks, again = tee(runs.ticks(run))
    for tick, (_, outputs) in zip(ticks, replay(context, again), strict=True):
        difference = difference or comparison.tick(tick.tick, outputs)
        if tape is not None:
            tape.write(tick, runs.inputs(tick), outputs)
        elif difference is not None:
            break
    return difference or comparison.unsaid()


def _verify_onto(path: Path, runs: RecordedRuns) -> Verdict:
    from tailor.tools.lockstep.run_writer import RunWriter  # it brings the live shell, and with it the bus

    if path.exists():
        raise UsageError(f"--output {path}: there is such a file already, expected a new one")
    run = runs.runs[0]
    context = rebuild_context(run.provenance)
    tape = RunWriter(path, context, {**run.provenance, "machine": platform_fingerprint()})
    try:
        return verify(runs, run, context, tape)
    finally:
        tape.close()


def told(verdict: Verdict) -> str:
    """A verdict in a line, and what is known of the machines, and of what was left out, in others."""
    what = f"{verdict.compared} messages of {verdict.ticks} ticks ({verdict.times_real_time:.0f} times real time)"
    left_out = f"\n  {verdict.left_out}" if verdict.left_out else ""
    machines = f"\n  recorded on {verdict.machines}" if verdict.machines else ""
    if verdict.difference is not None:
        return f"different: {verdict.difference}{machines}{left_out}"
    if verdict.rounded:
        return f"equal within {ROUNDING:g}: {what}; {verdict.rounded} of them not to the last bit{machines}{left_out}"
    return f"equal: {what}{left_out}"
