"""Soak: whole systems under one random fault a minute, their invariants checked at the body, their memory measured.

`tailor/tools/soak/` holds its parts: the systems and who looks after them (`soak.py`), the faults with their rows of
the table of faults (`faults/kinds.py`), when which one comes, and how that lets processes live for long enough to
measure slopes (`schedule.py`), what counts as motion without leave (`judging/motion.py`). Lateness during a measured
stall of the machine is listed, but does not fail the soak; motion without leave always does.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from tailor.schemas.errors import UsageError
from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.soak import report
from tailor.tools.soak.faults.kinds import DEADLY, FAULTS, HARMLESS, SETTLING
from tailor.tools.soak.judging.slopes import growth
from tailor.tools.soak.party import Party
from tailor.tools.soak.recordings import recording_rows
from tailor.tools.soak.schedule import Planned, schedule
from tailor.tools.soak.soak import Soak


@dataclass(frozen=True, slots=True)
class Options:
    """Flags of `tailor bench soak`."""

    minutes: int
    seed: int
    every_s: int  # one fault each
    only: str  # faults whose name contains this
    output: Path  # JSON
    as_json: bool


def run(console: Console, options: Options) -> bool:
    """Soak, print the tables, write the JSON file.

    Returns:
      Whether all invariants held, all memory is flat, and all faults could be injected.

    Raises:
      NoMeasurement: No tick, no motion or no fault.
      UsageError: There is no such fault.
    """
    shown = Console(stderr=True) if options.as_json else console
    with TemporaryDirectory(prefix="soak-") as folder, _progress(shown, options.minutes) as progress:
        soak = Soak(options.seed, Path(folder), progress)
        soak.run(_planned(options, list(soak.parties)), options.minutes * 60.0)
        content = _content(soak)
    options.output.parent.mkdir(parents=True, exist_ok=True)
    options.output.write_text(json.dumps(content, indent=1) + "\n")
    check_measured(content)
    if options.as_json:
        print(json.dumps(content, indent=1))
    else:
        _print(console, content)
    return bool(content["passed"])


def _planned(options: Options, robots: list[str]) -> list[Planned]:
    harmless, deadly = ([name for name in faults if options.only in name] for faults in (HARMLESS, DEADLY))
    if not harmless and not deadly:
        raise UsageError(f"--only {options.only}: no such fault, expected some of: {', '.join(FAULTS)}")
    settling = [name for name in SETTLING if name in harmless]
    hands = (harmless or deadly, deadly or harmless, settling)
    return schedule(options.seed, options.minutes, options.every_s, robots, *hands)


def check_measured(content: dict[str, Any]) -> None:
    """Raise NoMeasurement for each system without a tick, a command or motion, and for a soak without a fault."""
    for robot, system in content["systems"].items():
        missing = [name for name in ("ticks", "commands", "motion_s") if not system[name]]
        if missing:
            raise NoMeasurement(f"{robot} has no {', no '.join(missing)}")
    if not content["records"]:
        raise NoMeasurement("no fault was injected")


def _content(soak: Soak) -> dict[str, Any]:
    result = soak.result
    growths = {
        (robot, name, pid): growth(samples)
        for robot, party in soak.parties.items()
        for (name, pid), samples in party.watch.memory.items()
    }
    violations, memory = report.violation_rows(result.violations), report.memory_rows(growths)
    return {
        "seed": result.seed,
        "minutes": round(result.duration_s / 60, 2),
        "passed": not result.failed_faults
        and all(each["excused"] for each in violations)
        and all(row["flat"] for row in memory),
        "violations": violations,
        "systems": {robot: _system(party) for robot, party in soak.parties.items()},
        "faults": report.fault_rows(result.records),
        "not_injected": result.failed_faults,
        "memory": memory,
        "worst_stall_s": round(result.worst_stall_s, 3),
        "records": [report.record_row(record) for record in result.records],
    }


def _system(party: Party) -> dict[str, Any]:
    recordings = recording_rows(party.system.recordings)
    people = {"tasks": party.tasks, "latched_faults": party.faults}
    return {**asdict(party.system.totals), **people, "own_stops": party.stops, "recordings": recordings}


def _print(console: Console, content: dict[str, Any]) -> None:
    console.print(report.fault_table(content["faults"]))
    for row in content["faults"]:
        for note in row["notes"]:
            console.print(f"{row['fault']}: {note}", markup=False)
    console.print(report.memory_table(content["memory"]))
    for robot, system in content["systems"].items():
        readable = sum(not row["error"] for row in system["recordings"])
        console.print(
            f"{robot}: {system['ticks']} ticks, {system['skipped']} skipped, latest {system['worst_late_ms']:.0f} ms; "
            f"{system['tasks']} tasks, {system['motion_s']:.0f} s in motion, {system['own_stops']} stops by itself; "
            f"{readable} of {len(system['recordings'])} recordings readable"
        )
        for cause in system["latched_faults"]:
            console.print(f"{robot}: people cleared a fault of the executive: {cause}", markup=False)
    for line in content["not_injected"]:
        console.print(f"not injected: {line}", markup=False)
    for each in content["violations"]:
        console.print(report.violation_line(each), markup=False)
    excused = sum(each["excused"] for each in content["violations"])
    console.print(
        f"{content['minutes']} min, seed {content['seed']}: {len(content['records'])} faults, "
        f"{len(content['violations']) - excused} violations, {excused} late in a stall of the machine "
        f"(worst stall {content['worst_stall_s']} s)"
    )


@contextmanager
def _progress(console: Console, minutes: int) -> Iterator[Callable[[float, str], None]]:
    """A bar over the soak's time, and a line for each event."""
    columns = (TextColumn("soak"), BarColumn(), TimeElapsedColumn(), TextColumn("{task.description}"))
    with Progress(*columns, console=console, transient=True, refresh_per_second=1) as progress:
        task = progress.add_task("", total=minutes * 60.0)

        def show(at_s: float, line: str) -> None:
            progress.update(task, completed=at_s)
            if line:
                progress.update(task, description=line[:60])
                progress.console.print(f"{at_s:8.1f} s  {line}", markup=False, highlight=False)

        yield show
