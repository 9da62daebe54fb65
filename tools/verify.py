"""Feed a recording's inputs and granted checks through today's core and compare every output, bit for bit.

With --output, what today's core says is written as a recording of its own; `tailor compare` shows the two side by side.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import time
from collections import defaultdict
from dataclasses import dataclass
from itertools import tee
from pathlib import Path
from typing import TYPE_CHECKING

from executive.composition import recompose
from executive.core.context import Context
from executive.core.state import Output
from executive.replay import replay
from runtime.machine import contrast, machine, same_kind
from runtime.recording import Recorded
from schemas.codec import encode
from schemas.errors import UsageError
from schemas.messages import Message
from schemas.topics import key_of
from tools.differences import ROUNDING, Difference, first_field, rounding_apart
from tools.recorded_run import RecordedRun, RecordedRuns, decoded

if TYPE_CHECKING:
    from tools.run_tape import RunTape


@dataclass(frozen=True, slots=True)
class Verdict:
    """How a run compares: equal when `difference` is None."""

    sender: str
    ticks: int
    compared: int  # messages
    rounded: int  # of them, equal but for rounding; 0 unless the machine that recorded is of another kind
    difference: Difference | None
    machines: str  # what differs between the recording machine and this one
    took_s: float

    @property
    def times_real_time(self) -> float:
        """Seconds of the run per second of verifying, at ten ticks a second."""
        return self.ticks / 10 / self.took_s


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor verify`."""
    parser.add_argument("recording", type=Path, help="an MCAP file of `tailor record` or `tailor up --record`")
    parser.add_argument("--json", action="store_true", help="print the verdicts as JSON")
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE", help="write what today's core says, as a recording of its own"
    )


def run(arguments: argparse.Namespace) -> int:
    """0 when every run in the file is equal, 1 when one differs, 2 when the file cannot be verified."""
    runs = RecordedRuns(arguments.recording)
    if arguments.output is None:
        verdicts = [verify(runs, found, recompose(found.provenance)) for found in runs.runs]
    else:
        verdicts = [_verify_onto(arguments.output, runs)]
    if arguments.json:
        print(json.dumps([dataclasses.asdict(verdict) for verdict in verdicts], indent=1))
    else:
        for verdict in verdicts:
            print(told(verdict))
    return int(any(verdict.difference for verdict in verdicts))


def verify(runs: RecordedRuns, run: RecordedRun, context: Context, tape: RunTape | None = None) -> Verdict:
    """Compare one run with what today's core makes of it, up to the first difference.

    Rounding is forgiven only if the recording comes from another kind of machine (`runtime.machine`).

    Args:
      runs: The recording.
      run: One of its runs.
      context: What today's core is given, as `recompose` makes it.
      tape: Where to write what it says; it then goes on to the end, whatever differs.
    """
    here, there = machine(), run.provenance.get("machine", {})
    began = time.perf_counter()
    comparison = _Comparison(run, context.domain.robot, exact=same_kind(there, here))
    difference = None
    ticks, again = tee(runs.ticks(run))
    for tick, (_, outputs) in zip(ticks, replay(context, again), strict=True):
        difference = difference or comparison.tick(tick.tick, outputs)
        if tape is not None:
            tape.write(tick, runs.inputs(tick), outputs)
        elif difference is not None:
            break
    difference = difference or comparison.unsaid()
    took_s = time.perf_counter() - began
    return Verdict(
        run.sender,
        comparison.ticks,
        comparison.compared,
        comparison.rounded,
        difference,
        contrast(there, here),
        took_s,
    )


def _verify_onto(path: Path, runs: RecordedRuns) -> Verdict:
    from tools.run_tape import RunTape  # it brings the live shell, and with it the bus

    if path.exists():
        raise UsageError(f"--output {path}: there is such a file already, expected a new one")
    run = runs.runs[0]
    context = recompose(run.provenance)
    tape = RunTape(path, context, {**run.provenance, "machine": machine()})
    try:
        return verify(runs, run, context, tape)
    finally:
        tape.close()


class _Comparison:
    """What a run said against what is said today, message by message."""

    def __init__(self, run: RecordedRun, robot: str, exact: bool) -> None:
        self.ticks = self.compared = self.rounded = 0
        self._run, self._robot, self._exact = run, robot, exact
        self._taken: dict[str, int] = defaultdict(int)

    def tick(self, tick: int, outputs: tuple[Output, ...]) -> Difference | None:
        """The first difference in what is said in a tick."""
        self.ticks = tick
        for output in outputs:
            key = key_of(output.topic, self._robot)
            recorded, number = self._run.said.get(key, []), self._taken[key]
            self._taken[key] += 1
            if number >= len(recorded) and tick == self._run.ticks[-1].tick:
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
        key = next((key for key, messages in self._run.said.items() if len(messages) > self._taken[key]), None)
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


def told(verdict: Verdict) -> str:
    """A verdict in a line, and what is known of the machines in another."""
    what = f"{verdict.compared} messages of {verdict.ticks} ticks ({verdict.times_real_time:.0f} times real time)"
    machines = f"\n  recorded on {verdict.machines}" if verdict.machines else ""
    if verdict.difference is not None:
        return f"different: {verdict.difference}{machines}"
    if verdict.rounded:
        return f"equal within {ROUNDING:g}: {what}; {verdict.rounded} of them not to the last bit{machines}"
    return f"equal: {what}"
