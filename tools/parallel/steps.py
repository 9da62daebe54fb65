"""Progress of work that consists of several steps."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from rich.progress import BarColumn, MofNCompleteColumn, TaskID, TextColumn, TimeRemainingColumn

from tailor.tools.parallel.progress_lines import ProgressLines


@dataclass(frozen=True, slots=True)
class Step:
    """Progress of one step: `done` of `total` parts."""

    title: str
    done: int
    total: int


def counted(title: str, running: Iterable[int], total: int, done: int = 0) -> Iterator[Step]:
    """Steps of work that yields numbers of finished parts.

    Args:
      title: Of the step.
      running: The work.
      total: Number of parts.
      done: Number of parts that were finished before.
    """
    yield Step(title, done, total)
    for count in running:
        done += count
        yield Step(title, done, total)


def show(steps: Iterable[Step], quiet: bool, reached: dict[str, tuple[Step, Step]], prefix: str = "") -> None:
    """Run steps with a progress bar each; without a terminal, with lines.

    Args:
      steps: The work.
      quiet: Show nothing.
      reached: Filled with the first and the newest progress of each step by title, also if the work is interrupted.
      prefix: Before the title of each step.
    """
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    lines = ProgressLines(quiet)
    with lines.bars(*columns) as progress:
        tasks: dict[str, TaskID] = {}
        for step in steps:
            first, _ = reached.get(step.title, (step, step))
            reached[step.title] = first, step
            lines.report(f"{prefix}{step.title}", step.done, step.total)
            if step.title not in tasks:
                tasks[step.title] = progress.add_task(f"{prefix}{step.title}", total=step.total)
            progress.update(tasks[step.title], completed=step.done)
