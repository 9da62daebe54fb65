"""Feed a recording's inputs and granted checks through today's core and compare every output, bit for bit."""

from __future__ import annotations

import argparse
import dataclasses
import json
import time
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from executive.composition import recompose
from executive.core.context import Context
from executive.core.state import Output
from executive.replay import replay
from runtime.recording import Recorded
from schemas.codec import encode
from schemas.topics import key_of
from tools.recorded_run import RecordedRun, RecordedRuns, decoded


@dataclass(frozen=True, slots=True)
class Difference:
    """The first place where today's core says something else."""

    tick: int
    key: str
    field: str
    recorded: str
    today: str

    def __str__(self) -> str:
        return f"tick {self.tick}, {self.key}, {self.field}: recorded {self.recorded}, today {self.today}"


@dataclass(frozen=True, slots=True)
class Verdict:
    """How a run compares: equal when `difference` is None."""

    sender: str
    ticks: int
    compared: int  # messages
    difference: Difference | None
    took_s: float

    @property
    def times_real_time(self) -> float:
        """Seconds of the run per second of verifying, at ten ticks a second."""
        return self.ticks / 10 / self.took_s


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor verify`."""
    parser.add_argument("recording", type=Path, help="an MCAP file of `tailor record` or `tailor up --record`")
    parser.add_argument("--json", action="store_true", help="print the verdicts as JSON")


def run(arguments: argparse.Namespace) -> int:
    """0 when every run in the file is equal, 1 when one differs, 2 when the file cannot be verified."""
    runs = RecordedRuns(arguments.recording)
    verdicts = [verify(runs, found, recompose(found.provenance)) for found in runs.runs]
    if arguments.json:
        print(json.dumps([dataclasses.asdict(verdict) for verdict in verdicts], indent=1))
    else:
        for verdict in verdicts:
            print(_line(verdict))
    return int(any(verdict.difference for verdict in verdicts))


def verify(runs: RecordedRuns, run: RecordedRun, context: Context) -> Verdict:
    """Compare one run with what today's core makes of it."""
    began = time.perf_counter()
    taken: dict[str, int] = defaultdict(int)
    compared, ticks = 0, 0
    for tick, outputs in replay(context, runs.ticks(run)):
        ticks = tick
        for output in outputs:
            key = key_of(output.topic, context.domain.robot)
            recorded, number = run.said.get(key, []), taken[key]
            taken[key] += 1
            if number >= len(recorded) and tick == run.ticks[-1].tick:
                continue  # the recording ended within this tick
            difference = _compare(tick, key, recorded[number] if number < len(recorded) else None, output)
            compared += 1
            if difference is not None:
                return Verdict(run.sender, ticks, compared, difference, time.perf_counter() - began)
    spoken = next((k for k, messages in run.said.items() if len(messages) > taken[k]), None)
    extra = None
    if spoken is not None:
        extra = Difference(ticks, spoken, "message", f"number {taken[spoken] + 1}", "none")
    return Verdict(run.sender, ticks, compared, extra, time.perf_counter() - began)


def _compare(tick: int, key: str, recorded: Recorded | None, output: Output) -> Difference | None:
    if recorded is None:
        return Difference(tick, key, "message", "none", str(output.message))
    if recorded.data == encode(output.message):
        return None
    then = decoded(recorded)
    if type(then) is not type(output.message):
        return Difference(tick, key, "type", type(then).__name__, type(output.message).__name__)
    name, old, new = _first_field(then, output.message)
    return Difference(tick, key, name, str(old), str(new))


def _first_field(then: Any, now: Any) -> tuple[str, Any, Any]:
    for entry in dataclasses.fields(then):
        old, new = getattr(then, entry.name), getattr(now, entry.name)
        if old != new:
            return entry.name, old, new
    return "bytes", "other bytes for the same values", ""


def _line(verdict: Verdict) -> str:
    speed = f"{verdict.times_real_time:.0f} times real time"
    if verdict.difference is None:
        return f"equal: {verdict.compared} messages of {verdict.ticks} ticks ({speed})"
    return f"different: {verdict.difference}"
