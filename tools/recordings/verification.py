"""Verifies recorded runs: feeds their inputs through today's core and compares the outputs bit for bit."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import tee
from typing import Protocol

from tailor.executive.core.state import Output
from tailor.executive.deliberation.context import PERIOD_NS, Context
from tailor.executive.replay import RecordedTick, replay
from tailor.runtime.gc_freeze import gc_frozen
from tailor.runtime.platform_fingerprint import contrast, platform_fingerprint, same_kind, same_products
from tailor.schemas.errors import UsageError
from tailor.schemas.installed.core_source import core_source
from tailor.tools.cli.plain_text import plain
from tailor.tools.recordings.core_comparison import RunComparison, without_proofs
from tailor.tools.recordings.differences import PROOF_ROUNDING_PCT, ROUNDING, Difference
from tailor.tools.recordings.executive_run import RecordedRun
from tailor.tools.recordings.recorded_run import RecordedRuns
from tailor.tools.recordings.recorded_source import source_contrast

MAY_BE_LOSS = "\n  unless the recording lost it: of {} nothing later is recorded whose number would show that"
END_NS = 2**31 * 10**9  # of the seconds in a ROS message


class TickWriter(Protocol):
    """Writes the ticks of today's core, e.g. tailor.tools.lockstep.run_writer.RunWriter."""

    def write(self, tick: RecordedTick, inputs: Sequence[bytes], outputs: tuple[Output, ...]) -> None:
        """Write one tick."""
        ...


@dataclass(frozen=True, slots=True)
class Verdict:
    """Result of a verification; the run is equal if `difference` is None."""

    sender: str
    ticks: int
    compared: int  # messages
    rounded: int  # of them equal except for rounding; 0 unless recorded on a platform that computes otherwise
    difference: Difference | None
    machines: str  # differences between the recording platform and this one
    left_out: str  # messages on exec/tick that are not ticks of an executive; empty if none
    took_s: float  # without reading the file, loading models and compiling codecs
    ends: str = ""  # why the comparison ends before the run does; empty if it does not
    source: str = ""  # whether today's source recorded it; empty without a difference
    lost: str = ""  # outputs that were published and are not recorded, by key; empty if there are none

    @property
    def times_real_time(self) -> float:
        """Recorded seconds per second of verification."""
        return self.ticks * PERIOD_NS / 1e9 / self.took_s


def verify(
    runs: RecordedRuns,
    run: RecordedRun,
    context: Context,
    writer: TickWriter | None = None,
    proofs: bool = True,
    partly: bool = False,
) -> Verdict:
    """Compare one recorded run with the outputs of today's core, up to the first difference.

    Rounding is tolerated only if the recording platform is of another kind (see `platform_fingerprint`), that of
    optimality gaps also if it multiplies matrices otherwise.

    Args:
      runs: The recording.
      run: One of its runs.
      context: Context for today's core, from `rebuild_context`.
      writer: Receives the outputs of today's core; the comparison then continues to the end of the run.
      proofs: Whether to compute and compare optimality gaps, too.
      partly: Whether to compare the ticks before one that is not recorded, or whose inputs are not; see Verdict.ends.

    Raises:
      UsageError: The recording lacks a tick or an input, and, if `partly`, there is none before it.
    """
    here, there = platform_fingerprint(), run.provenance.get("machine", {})
    kin = same_kind(there, here)
    comparison = RunComparison(
        run, context.domain.robot, kin, same_products(there, here), proofs=proofs, dropped=runs.dropped
    )
    with gc_frozen():  # as live
        began_s = time.perf_counter()
        used = context if proofs else without_proofs(context)
        difference, ends = _compared(comparison, runs, run, used, writer, partly)
        took_s = time.perf_counter() - began_s
    return Verdict(
        run.sender,
        comparison.ticks,
        comparison.compared,
        comparison.rounded,
        difference,
        contrast(there, here),
        runs.left_out_text(),
        took_s,
        ends,
        source_contrast(run.provenance.get("source"), core_source(context.domain.name), kin) if difference else "",
        comparison.lost(),
    )


def _compared(
    comparison: RunComparison,
    runs: RecordedRuns,
    run: RecordedRun,
    context: Context,
    writer: TickWriter | None,
    partly: bool,
) -> tuple[Difference | None, str]:
    """The first difference, and why the comparison ends before the run does; empty if it does not."""
    try:
        return _first_difference(comparison, runs, run, context, writer), ""
    except UsageError as error:
        if not partly or not comparison.ticks:
            raise
        return None, str(error)


def _first_difference(
    comparison: RunComparison, runs: RecordedRuns, run: RecordedRun, context: Context, writer: TickWriter | None
) -> Difference | None:
    difference = None
    ticks, inputs = tee(_in_time(runs, run, context))
    for tick, (_, outputs) in zip(ticks, replay(context, inputs), strict=True):
        difference = difference or comparison.tick(tick.tick, outputs)
        if writer is not None:
            writer.write(tick, runs.inputs(tick), outputs)
        elif difference is not None:
            break
    return difference or comparison.missing()


def _in_time(runs: RecordedRuns, run: RecordedRun, context: Context) -> Iterator[RecordedTick]:
    """Ticks of a run; raises UsageError at one whose times no message can state."""
    for tick in runs.ticks(run):
        for time_ns in (tick.now_ns, *(sample.arrival_ns for sample in tick.inputs.samples)):
            if not 0 <= (stamp_ns := context.stamp(time_ns)) < END_NS:
                problem = f"tick {tick.tick} has a time of {stamp_ns} ns, expected 0 to {END_NS:g}"
                raise UsageError(f"{runs.path}: {problem}, as messages state times")
        yield tick


def verdict_text(verdict: Verdict) -> str:
    """The verdict in one line; further lines on an early end, platforms and ignored messages if there are any."""
    summary = f"{verdict.compared} messages of {verdict.ticks} ticks ({verdict.times_real_time:.0f} times real time)"
    left_out = f"\n  {plain(verdict.left_out)}" if verdict.left_out else ""
    lost = f"\n  not recorded, thus not compared: {plain(verdict.lost)}" if verdict.lost else ""
    ends = f"\n  not verified to the end: {plain(verdict.ends)}" if verdict.ends else ""
    machines = f"\n  recorded on {plain(verdict.machines)}" if verdict.machines else ""
    if verdict.difference is not None:
        doubt = MAY_BE_LOSS.format(plain(verdict.difference.key)) if verdict.difference.may_be_loss else ""
        return f"different: {plain(str(verdict.difference))}\n  {verdict.source}{doubt}{lost}{machines}{left_out}"
    if verdict.rounded:
        rounded = f"{verdict.rounded} of them not to the last bit"
        within = f"{ROUNDING:g}, gaps within {PROOF_ROUNDING_PCT:g} %"
        return f"equal within {within}: {summary}; {rounded}{lost}{ends}{machines}{left_out}"
    return f"equal: {summary}{lost}{ends}{left_out}"
