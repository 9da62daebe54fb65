"""Episodes watched closely, for figures that draw what happened: the track, what was said, and the outcome."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from joblib import Parallel, delayed
from rich.progress import track

from tailor.executive.core.context import Context
from tailor.schemas.messages import Message, Subgoals
from tailor.tools.evaluations.outcome import Outcome, Task, Variant, outcome_of
from tailor.tools.evaluations.task_runs import run_task
from tailor.tools.figures.track import Track, track_of


@dataclass(frozen=True, slots=True)
class TracedRun:
    """One episode: what came of it, its path, and the choices in the order in which they were made."""

    outcome: Outcome
    track: Track
    subgoals: tuple[Subgoals, ...]


def trace_run(task: Task, variant: Variant, seed: int) -> tuple[TracedRun, Context]:
    """Run an episode and keep what figures are drawn from."""
    episode, context = run_task(task, variant, seed)
    messages: Sequence[Message] = episode.messages
    outcome = outcome_of(episode, context.domain, variant.name, seed)
    return TracedRun(outcome, track_of(variant.name, messages), tuple(episode.subgoals)), context


def trace_all(
    task: Task, variants: Sequence[Variant], seeds: Sequence[int], jobs: int, title: str
) -> dict[tuple[str, int], TracedRun]:
    """Every variant at every seed, by name and seed."""
    wanted = [(variant, seed) for seed in seeds for variant in variants]
    running = Parallel(n_jobs=jobs, return_as="generator")(
        delayed(_watched)(task, variant, seed) for variant, seed in wanted
    )
    found = track(running, title, total=len(wanted), transient=True)
    return {(variant.name, seed): watched for (variant, seed), watched in zip(wanted, found, strict=True)}


def _watched(task: Task, variant: Variant, seed: int) -> TracedRun:
    return trace_run(task, variant, seed)[0]
