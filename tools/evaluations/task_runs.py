"""Runs of tasks for evaluations: equal starts under several settings, in parallel, stored as they finish.

Scenario, seed and variant determine a run, so an interrupted evaluation resumes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tailor.executive import domains
from tailor.executive.deliberation.context import Context, Settings, make_context
from tailor.simnodes.world import World
from tailor.tools.evaluations.dependencies import dependencies
from tailor.tools.evaluations.detours.controller import with_detours
from tailor.tools.evaluations.journal import Journal
from tailor.tools.evaluations.outcome import Outcome, Task, Variant, outcome_of
from tailor.tools.evaluations.pinned import PinnedDomain
from tailor.tools.evaluations.progress import tracked
from tailor.tools.evaluations.tick_budget import tick_budget
from tailor.tools.learning.gathering.choosing_models import cached_models
from tailor.tools.lockstep.bodies import body_of
from tailor.tools.lockstep.run import SENDER, Run, run_lockstep
from tailor.tools.lockstep.worlds import events_of
from tailor.tools.parallel.pool import completed

PIN_STREAM = 4
LIMIT_S = 240.0  # of simulated time: thirteen actions of a mobile manipulator take 90 s without a mishap


def run_all(
    task: Task,
    variants: Sequence[Variant],
    seeds: Iterable[int],
    jobs: int = 2,
    store: Path | None = None,
    title: str = "",
) -> dict[str, dict[int, Outcome]]:
    """Run every variant at every seed.

    Args:
      task: Scenario to run.
      variants: Settings, with unique names.
      seeds: Of the starts.
      jobs: Processes.
      store: Folder of finished runs, which are not run again; None stores nothing.
      title: Shown beside the progress bar.

    Returns:
      Outcomes by name of the variant and seed.
    """
    found: dict[str, dict[int, Outcome]] = {variant.name: {} for variant in variants}
    journals = {variant.name: Journal(store, task, variant, dependencies(task, variant)) for variant in variants}
    wanted = []
    for seed in seeds:
        for variant in variants:
            known = journals[variant.name].known.get(seed)
            if known is None:
                wanted.append((variant, seed))
            else:
                found[variant.name][seed] = known
    running = completed(run_one, [(task, variant, seed) for variant, seed in wanted], jobs)
    for _, outcome in tracked(running, title or task.scenario, len(wanted)):
        found[outcome.variant][outcome.seed] = outcome
        journals[outcome.variant].note(outcome)
    return found


def run_one(task: Task, variant: Variant, seed: int) -> Outcome:
    """Outcome of one run in lock-step."""
    episode, context = run_task(task, variant, seed)
    return outcome_of(episode, context.domain, variant.name, seed)


def run_task(task: Task, variant: Variant, seed: int) -> tuple[Run, Context]:
    """One run with all its messages, and its context.

    The variant's `noise` changes only the seed of the body's noise; the start stays the same.
    """
    context, start = _context(task, variant, seed)
    body, events = body_of(task.domain, task.profile), events_of(context.scenario)
    world = World(body, start, seed + variant.noise, events)
    return run_lockstep(context, world, limit_s=LIMIT_S, new_budget=tick_budget(task.tick_ms)), context


def paired(first: Mapping[int, Outcome], second: Mapping[int, Outcome]) -> tuple[list[float], list[float]]:
    """Durations at the seeds where both runs achieved the goal."""
    seeds = [seed for seed in sorted(first) if seed in second and first[seed].achieved and second[seed].achieved]
    return [first[seed].duration_s for seed in seeds], [second[seed].duration_s for seed in seeds]


def _context(task: Task, variant: Variant, seed: int) -> tuple[Context, dict[str, float]]:
    domain = domains.load(task.domain)
    if variant.hand_made:
        domain = with_detours(domain, task.domain, task.scenario)
    scenario, start = domains.seeded_scenario(task.domain, task.scenario, seed)
    pins = {(label, quantity): value for label, quantity, value in variant.pins}
    drawing = np.random.default_rng([seed, PIN_STREAM])
    pins |= {(label, quantity): float(drawing.uniform(lower, upper)) for label, quantity, lower, upper in task.drawn}
    pinned: Any = PinnedDomain(domain, pins)
    # certificates take time and change no measured value
    settings = Settings(seed=seed, refinement=replace(variant.refinement, certify_checks=0))
    models, doubts = cached_models(domain.robot, task.zoo), domains.doubts(task.domain)
    context = make_context(pinned, scenario, models, settings, SENDER, doubts=doubts)
    if task.goal:
        context = replace(context, problem=context.problem.with_goal(task.goal))
    return context, start
