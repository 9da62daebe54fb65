"""Gathering as people see it: progress, notes, and what an interruption kept."""

from __future__ import annotations

import json
import time
from collections.abc import Iterable
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn

from tailor.tools.learning.gathering import random_episodes
from tailor.tools.learning.gathering.data_set_spec import DataSetSpec
from tailor.tools.parallel.progress_lines import ProgressLines
from tailor.tools.parallel.steps import Step, show


def gathered(spec: DataSetSpec, jobs: int, quiet: bool) -> dict[str, object]:
    """Gather the missing episodes of a data set, with progress unless `quiet`; returns its figures."""
    left, started = random_episodes.missing_episodes(spec), time.perf_counter()
    simulated = busy = 0.0
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[rate]}"))
    lines, done = ProgressLines(quiet), spec.episodes - left
    lines.report(spec.action, done, spec.episodes)
    with lines.bars(*columns, TimeRemainingColumn()) as progress:
        task = progress.add_task(spec.action, total=spec.episodes, completed=done, rate="")
        for count, sim_s, wall_s in random_episodes.gather(spec, random_episodes.missing_parts(spec), jobs):
            simulated, busy, done = simulated + sim_s, busy + wall_s, done + count
            lines.report(spec.action, done, spec.episodes)
            speed = simulated / busy if busy else 0.0
            progress.update(task, advance=count, rate=f"{speed:.0f} × real time per core")
    return {
        "action": spec.action,
        "folder": str(spec.folder),
        "episodes": left,
        "simulated_s": simulated,
        "wall_s": time.perf_counter() - started,
        "times_real_per_core": simulated / busy if busy else None,
    }


def shown(steps: Iterable[Step], out: Path, as_json: bool) -> int:
    """Show the progress of all steps; exit code 0, or 130 if interrupted."""
    reached: dict[str, tuple[Step, Step]] = {}  # first and newest by title
    try:
        show(steps, quiet=as_json, reached=reached)
    except KeyboardInterrupt:
        kept = ", ".join(f"{newest.done} of {newest.total} {title}" for title, (_, newest) in reached.items())
        note(f"{out}: kept {kept}; --resume continues")
        return 130
    if as_json:
        totals = {title: newest.total for title, (_, newest) in reached.items()}
        now = sum(newest.done - first.done for first, newest in reached.values())
        print(json.dumps({"folder": str(out), **totals, "run_now": now}))
    return 0


def note(line: str) -> None:
    """Print to standard error, in one line: brackets in a path are no markup."""
    Console(stderr=True).print(line, highlight=False, markup=False, soft_wrap=True)
