"""Compares the recorded outputs of an executive with those of today's core, message by message."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace
from typing import Any

from tailor.executive.core.state import Output
from tailor.executive.deliberation.context import Context
from tailor.runtime.recordings.recording import Recorded
from tailor.schemas.codec import encode
from tailor.schemas.messages import Message, RefinementReport
from tailor.schemas.topics import TOPICS, key_of
from tailor.tools.recordings.differences import NONE, Difference, first_field, rounding_apart, with_proof_of
from tailor.tools.recordings.executive_run import RecordedRun, decoded
from tailor.tools.recordings.recorded_outputs import Absent, RecordedOutputs, before_gap

REFINEMENT = TOPICS["refinement"].key


class RunComparison:
    """Comparison of one run: call `tick` for every tick, then `missing`.

    Args:
      run: Recorded run.
      robot: Name of the robot, part of its topics.
      exact: Whether every bit counts; else rounding is tolerated and counted.
      exact_proofs: The same of optimality gaps.
      proofs: Whether optimality gaps are compared, too.
      dropped: Keys of which the recorder dropped messages: what follows the last one of such a key may be lost.
    """

    def __init__(
        self,
        run: RecordedRun,
        robot: str,
        exact: bool,
        exact_proofs: bool,
        proofs: bool = True,
        dropped: Collection[str] = (),
    ) -> None:
        self.ticks = self.compared = self.rounded = 0
        self._robot, self._exact, self._exact_proofs, self._proofs = robot, exact, exact_proofs, proofs
        self._reports, self._dropped = run.ticks, dropped
        self._published = {key: RecordedOutputs(messages, key in dropped) for key, messages in run.published.items()}
        self._last_report: Message | None = None  # of refinement, without its gap
        if not proofs and REFINEMENT in run.published:
            whole = before_gap(reports := run.published[REFINEMENT])  # beyond, no number tells which one is which
            self._published[REFINEMENT] = RecordedOutputs(
                _without_proofs(whole), len(whole) < len(reports) or REFINEMENT in dropped
            )

    def tick(self, tick: int, outputs: tuple[Output, ...]) -> Difference | None:
        """First difference between the recorded outputs of a tick and today's."""
        self.ticks = tick
        for output in outputs:
            key = key_of(output.topic, self._robot)
            if not self._proofs and key == REFINEMENT and self._is_repeated(output.message):
                continue
            outputs_then = self._published.setdefault(key, RecordedOutputs((), key in self._dropped))
            recorded = outputs_then.take(ends_here=tick == self._reports[-1].tick)
            if recorded is Absent.LOST:
                continue
            self.compared += 1
            if isinstance(recorded, Absent):
                return Difference(tick, key, "message", NONE, str(output.message))
            difference = self._message(tick, recorded, output.message)
            if difference is not None:
                return difference
        return None

    def missing(self) -> Difference | None:
        """A recorded message that today's core did not publish by the end of the run.

        One of a tick without a report counts as none: its executive ended, or the recording does, within that tick.
        """
        left = [
            (self._tick_of(decoded(following)), key, outputs.taken + 1)
            for key, outputs in self._published.items()
            if (following := outputs.following) is not None
        ]
        reported = [each for each in left if each[0] <= self._reports[-1].tick]
        if not reported:
            return None
        tick, key, number = min(reported)
        return Difference(tick, key, "message", f"number {number}", NONE)

    def _tick_of(self, message: Message) -> int:
        """Number of the tick that a message was published in; one beyond the last one without a report."""
        stamp_ns, last = getattr(message, "stamp_ns", 0), self._reports[-1]
        if not stamp_ns:
            return last.tick
        return next((report.tick for report in self._reports if report.stamp_ns >= stamp_ns), last.tick + 1)

    def lost(self) -> str:
        """Outputs that were published and are not recorded, as text; empty if there are none."""
        return ", ".join(f"{outputs.lost} of {key}" for key, outputs in self._published.items() if outputs.lost)

    def _message(self, tick: int, recorded: Recorded, today: Message) -> Difference | None:
        if recorded.data == encode(today):
            return None
        then = decoded(recorded)
        if self._is_rounded(then, today):
            self.rounded += 1
            return None
        field, old, new = first_field(then, today)
        return Difference(tick, recorded.key, field, str(old), str(new))

    def _is_rounded(self, then: Message, today: Message) -> bool:
        """Whether only what this comparison tolerates lies between two different messages."""
        same = then if self._exact_proofs else with_proof_of(then, today)
        return encode(same) == encode(today) if self._exact else rounding_apart(same, today)

    def _is_repeated(self, message: Message) -> bool:
        before, self._last_report = self._last_report, _timeless(message)
        return self._last_report == before


def without_proofs(context: Context) -> Context:
    """Context without proofs of optimality gaps. They come last in a tick and change no other output."""
    refinement = replace(context.settings.refinement, certify_checks=0)
    return replace(context, settings=replace(context.settings, refinement=refinement))


def _without_proofs(messages: Iterable[Recorded]) -> list[Recorded]:
    """Refinement reports without gaps and numbers; reports that change nothing else are omitted."""
    kept: list[Recorded] = []
    last: Any = None
    for recorded in messages:
        report = decoded(recorded)
        assert isinstance(report, RefinementReport)
        before, last = last, _timeless(report)
        if last != before:
            kept.append(replace(recorded, sequence=0, data=encode(replace(report, gap_pct=-1.0))))
    return kept


def _timeless(report: Any) -> Any:
    return replace(report, stamp_ns=0, tick=0, gap_pct=-1.0)
