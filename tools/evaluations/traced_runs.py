"""Runs with their tracks and subgoals, for figures that draw them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tailor.executive.deliberation.context import Context
from tailor.schemas.messages import Contexts, Subgoals
from tailor.tools.evaluations.outcome import Outcome, Task, Variant, outcome_of
from tailor.tools.evaluations.progress import tracked
from tailor.tools.evaluations.task_runs import run_task
from tailor.tools.figures.track import Track, track_of
from tailor.tools.parallel.pool import completed, in_order


@dataclass(frozen=True, slots=True)
class TracedRun:
    """One run: outcome, track, choices in order, and the objects that they were made among."""

    outcome: Outcome
    track: Track
    subgoals: tuple[Subgoals, ...]
    contexts: tuple[Contexts, ...] = ()

    @property
    def first_contexts(self) -> Contexts | None:
        """Objects of the first choice; None without any."""
        return next((each for each in self.contexts if each.tick == self.subgoals[0].tick), None)


def trace_run(task: Task, variant: Variant, seed: int) -> tuple[TracedRun, Context]:
    """Run a task and keep track and subgoals."""
    run, context = run_task(task, variant, seed)
    outcome = outcome_of(run, context.domain, variant.name, seed)
    track = track_of(variant.name, run.messages, context.domain.name)
    contexts = tuple(message for message in run.messages if isinstance(message, Contexts))
    return TracedRun(outcome, track, tuple(run.subgoals), contexts), context


def trace_all(
    task: Task, variants: Sequence[Variant], seeds: Sequence[int], jobs: int, title: str
) -> dict[tuple[str, int], TracedRun]:
    """Run every variant at every seed; runs by name of the variant and seed."""
    wanted = [(variant, seed) for seed in seeds for variant in variants]
    running = completed(_traced, [(task, variant, seed) for variant, seed in wanted], jobs)
    traced_runs = in_order(tracked(running, title, len(wanted)))
    return {(variant.name, seed): traced for (variant, seed), traced in zip(wanted, traced_runs, strict=True)}


def _traced(task: Task, variant: Variant, seed: int) -> TracedRun:
    return trace_run(task, variant, seed)[0]
