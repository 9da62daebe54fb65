"""What an executive said in a run against what today's core says, message by message."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from tailor.executive.core.context import Context
from tailor.executive.core.state import Output
from tailor.runtime.recordings.recording import Recorded
from tailor.schemas.codec import encode
from tailor.schemas.messages import Message, RefinementReport
from tailor.schemas.topics import TOPICS, key_of
from tailor.tools.recordings.differences import Difference, first_field, rounding_apart
from tailor.tools.recordings.recorded_run import RecordedRun, decoded

REFINEMENT = TOPICS["refinement"].key


class RunComparison:
    """Counts what it has compared; hand it every tick, then ask for what was left unsaid.

    Args:
      run: What was said.
      robot: Whose topics.
      exact: Whether every bit counts; else rounding is forgiven, and counted.
      proofs: Whether the proofs of how near a choice is to the optimum are compared, too.
    """

    def __init__(self, run: RecordedRun, robot: str, exact: bool, proofs: bool = True) -> None:
        self.ticks = self.compared = self.rounded = 0
        self._robot, self._exact, self._proofs = robot, exact, proofs
        self._last_tick = run.ticks[-1].tick
        self._said: dict[str, list[Recorded]] = dict(run.published)
        self._taken: dict[str, int] = defaultdict(int)
        self._told: Message | None = None  # of refinement, last, without proof
        if not proofs and REFINEMENT in run.published:
            self._said[REFINEMENT] = _without_proofs(run.published[REFINEMENT])

    def tick(self, tick: int, outputs: tuple[Output, ...]) -> Difference | None:
        """The first difference in what is said in a tick."""
        self.ticks = tick
        for output in outputs:
            key = key_of(output.topic, self._robot)
            if not self._proofs and key == REFINEMENT and self._is_retold(output.message):
                continue
            recorded, number = self._said.get(key, []), self._taken[key]
            self._taken[key] += 1
            if number >= len(recorded) and tick == self._last_tick:
                continue  # the recording ended within this tick
            self.compared += 1
            if number >= len(recorded):
                return Difference(tick, key, "message", "none", str(output.message))
            difference = self._message(tick, recorded[number], output.message)
            if difference is not None:
                return difference
        return None

    def unsaid(self) -> Difference | None:
        """A recorded message that today's core has not said by the end."""
        key = next((key for key, messages in self._said.items() if len(messages) > self._taken[key]), None)
        if key is None:
            return None
        return Difference(self.ticks, key, "message", f"number {self._taken[key] + 1}", "none")

    def _message(self, tick: int, recorded: Recorded, today: Message) -> Difference | None:
        if recorded.data == encode(today):
            return None
        then = decoded(recorded)
        if not self._exact and rounding_apart(then, today):
            self.rounded += 1
            return None
        field, old, new = first_field(then, today)
        return Difference(tick, recorded.key, field, str(old), str(new))

    def _is_retold(self, message: Message) -> bool:
        before, self._told = self._told, _timeless(message)
        return self._told == before


def without_proofs(context: Context) -> Context:
    """The context in which no choice is proven. Proving comes last in a tick and changes no answer."""
    refinement = replace(context.settings.refinement, certify_checks=0)
    return replace(context, settings=replace(context.settings, refinement=refinement))


def _without_proofs(messages: Iterable[Recorded]) -> list[Recorded]:
    """The reports of refinement without their gaps; those that told of nothing else are left out."""
    kept: list[Recorded] = []
    told: Any = None
    for recorded in messages:
        report = decoded(recorded)
        assert isinstance(report, RefinementReport)
        before, told = told, _timeless(report)
        if told != before:
            kept.append(replace(recorded, data=encode(replace(report, gap_pct=-1.0))))
    return kept


def _timeless(report: Any) -> Any:
    return replace(report, stamp_ns=0, tick=0, gap_pct=-1.0)
