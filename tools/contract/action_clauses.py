"""Clauses that concern each action: its sampler, its arguments, its controller."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tailor.tools.contract.clause import clause
from tailor.tools.contract.subject import Subject
from tailor.tools.contract.trial import command_fault

SAMPLES = 20
ROWS = 50


@clause("action", needs="sampler")
def samples_are_finite_and_vary(subject: Subject, case: str) -> Iterator[str]:
    """The sampler draws finite arguments, one for each parameter, that differ from draw to draw."""
    drawn = np.array([subject.sample(case, seed) for seed in range(SAMPLES)])
    if drawn.shape != (SAMPLES, len(subject.domain.actions[case].parameters)):
        yield f"sample has the shape {drawn.shape[1:]}, expected one number a parameter"
    elif not np.isfinite(drawn).all():
        yield "sample returns a number that is not finite"
    elif not np.ptp(drawn, axis=0).max() > 0.0:
        yield f"sample always returns {drawn[0].tolist()}"


@clause("action", needs="sampler")
def samples_follow_the_seed(subject: Subject, case: str) -> Iterator[str]:
    """Equal random generators give equal arguments, bit for bit."""
    for seed in range(SAMPLES):
        if not np.array_equal(subject.sample(case, seed), subject.sample(case, seed), equal_nan=True):
            yield f"sample returns two different values with seed {seed}: every draw must come from rng"
            return


@clause("action")
def batches_are_rows(subject: Subject, case: str) -> Iterator[str]:
    """`arguments` maps each row of a batch as it maps the row alone, and leaves the caller's array as it is."""
    action = subject.domain.actions[case]
    lower, upper = ([getattr(p, end) for p in action.parameters] for end in ("lower", "upper"))
    values = np.random.default_rng(3).uniform(lower, upper, (ROWS, len(lower)))
    before = values.copy()
    batch = action.arguments(values)
    if not np.array_equal(values, before):
        yield "arguments changes the array that it is given"
    elif not np.array_equal(batch, np.vstack([action.arguments(row[None, :]) for row in values])):
        yield "arguments of a batch differ from those of its rows"


@clause("action", needs="body")
def runs_follow_the_seed(subject: Subject, case: str) -> Iterator[str]:
    """Body, belief and controller are deterministic: equal arguments and generators give equal runs, bit for bit."""
    for seed in range(subject.runs):
        first = subject.run(case, seed)
        second = subject.run_with(case, first.arguments, seed)
        same = first.ticks.shape == second.ticks.shape and np.array_equal(first.ticks, second.ticks, equal_nan=True)
        if not same or (first.duration_s, first.failure) != (second.duration_s, second.failure):
            yield f"run {seed}: two runs of {case} with the same seed differ"


@clause("action", needs="body")
def commands_are_within_the_axes(subject: Subject, case: str) -> Iterator[str]:
    """The controller commands finite values, one for each axis that the action drives and within its limits."""
    if fault := command_fault(subject.domain, case, np.random.default_rng(0)):
        yield fault
        return
    axes = subject.domain.axes
    for seed in range(subject.runs):
        for tick in subject.run(case, seed).trace:
            if len(tick.command) != len(axes):
                yield f"run {seed}: {len(tick.command)} values at {tick.time_s:.1f} s, expected {len(axes)}"
                return
            for value, axis in zip(tick.command, axes, strict=True):
                if not axis.lower <= value <= axis.upper:
                    yield f"run {seed}: {axis.name} is {value:g} at {tick.time_s:.1f} s, beyond its limits"
                    return


@clause("action", needs="body")
def goals_are_reached(subject: Subject, case: str) -> Iterator[str]:
    """The controller reports its goal reached, from random starts, within the time limit.

    Of an action that names a model of success some runs may fail, not all.
    """
    runs = [subject.run(case, seed) for seed in range(subject.runs)]
    missed = [
        f"run {seed}: {run.failure} after {run.duration_s:.1f} s" for seed, run in enumerate(runs) if not run.done
    ]
    may_fail = bool(subject.domain.actions[case].success_model)  # learned from random runs of which some fail
    yield from missed if len(missed) == len(runs) or not may_fail else ()
