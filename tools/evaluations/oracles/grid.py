"""Oracle: simulates every choice of the first subgoal, as a bound on the improvement by learned models.

"Ceiling" is its fastest episode, "again" the same choice with other noise, "greedy" the episode with the fastest first
action, "zero" the choice of all zeros.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path

import numpy as np

from tailor.executive import domains
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.tools.evaluations.outcome import OTHER_NOISE, Outcome, Task, Variant
from tailor.tools.evaluations.task_runs import run_all

Free = tuple[str, str, float, float]  # label, quantity, lower, upper
N_AGAIN = 3  # repetitions of the oracle's choice


@dataclass(frozen=True, slots=True)
class Oracle:
    """Durations of one start in seconds; NaN if no choice reached the goal."""

    seed: int
    ceiling_s: float
    greedy_s: float
    zero_s: float
    again_s: float = float("nan")  # mean of the ceiling's choice, executed again with other noise


def subgoal_parameters(outcome: Outcome) -> list[Free]:
    """The free parameters that the first choice of an episode had, those of asserted subgoals left out."""
    return [(label, quantity, lo, hi) for label, quantity, lo, hi, _ in outcome.free if not label.startswith("subgoal")]


def simulate_choices(
    task: Task,
    free: Sequence[Free],
    seeds: Sequence[int],
    settings: RefinementSettings,
    points: int,
    jobs: int,
    store: Path | None,
) -> list[Oracle]:
    """Simulate a grid over the free parameters at every seed.

    Args:
      free: What is to be chosen; `points` values of an angle that wraps, a third of that (at least 3) of the rest.
      settings: Of the executive; its horizon is set to one, because nothing is left to look ahead for.
    """
    alone = replace(settings, horizon=1)
    grid = list(product(*_axes(task, free, points)))
    pins = [tuple((f[0], f[1], float(v)) for f, v in zip(free, choice, strict=True)) for choice in grid]
    zeros = tuple((f[0], f[1], float(np.clip(0.0, f[2], f[3]))) for f in free)
    variants = [Variant(_name(one), alone, one) for one in dict.fromkeys([*pins, zeros])]
    found = run_all(task, variants, seeds, jobs, store, f"{task.scenario}: oracle")
    judged = []
    for seed in seeds:
        one = _judged(seed, [found[v.name][seed] for v in variants], found[_name(zeros)][seed])
        best = [v for v in variants if found[v.name][seed].achieved and found[v.name][seed].duration_s == one.ceiling_s]
        judged.append(replace(one, again_s=_again_s(task, best[0], seed, jobs, store)) if best else one)
    return judged


def grid_size(task: Task, free: Sequence[Free], points: int) -> int:
    """Number of choices that `simulate_choices` would simulate at each seed."""
    return math.prod(len(values) for values in _axes(task, free, points))


def _axes(task: Task, free: Sequence[Free], points: int) -> list[list[float]]:
    periodic = {p.quantity for a in domains.load(task.domain).actions.values() for p in a.parameters if p.periodic}
    return [_values(parameter, points, parameter[1] in periodic) for parameter in free]


def _again_s(task: Task, best: Variant, seed: int, jobs: int, store: Path | None) -> float:
    """Mean duration of the best choice with other noise; the best of many noisy runs is biased."""
    again = [replace(best, name=f"again-{k}-{best.name}", noise=k * OTHER_NOISE) for k in range(1, N_AGAIN + 1)]
    found = run_all(task, again, [seed], jobs, store, f"{task.scenario}: oracle again")
    reached = [found[v.name][seed].duration_s for v in again if found[v.name][seed].achieved]
    return float(np.mean(reached)) if reached else float("nan")


def _judged(seed: int, outcomes: Sequence[Outcome], zero: Outcome) -> Oracle:
    achieved = [outcome for outcome in outcomes if outcome.achieved]
    zero_s = zero.duration_s if zero.achieved else float("nan")
    if not achieved:
        return Oracle(seed, float("nan"), float("nan"), zero_s)
    soonest = min(achieved, key=_first_action_s)
    return Oracle(seed, min(outcome.duration_s for outcome in achieved), soonest.duration_s, zero_s)


def _first_action_s(outcome: Outcome) -> float:
    """Seconds until the first action of the plan is done, asserted subgoals included; inf if it failed at first.

    0 for a goal that held at the start, which needs no action.
    """
    if not outcome.actions:
        return 0.0
    before = itertools.takewhile(lambda predicted: predicted[1], outcome.predicted_actions)
    end = min(sum(1 for _ in before), len(outcome.actions) - 1)
    return sum(outcome.actual_s[: end + 1]) if outcome.outcomes[end] == "done" else float("inf")


def _values(parameter: Free, points: int, periodic: bool) -> list[float]:
    *_, lower, upper = parameter
    if periodic:
        return list(np.linspace(lower, upper, points, endpoint=False))
    return list(np.linspace(lower, upper, max(3, points // 6)))


def _name(pins: Sequence[tuple[str, str, float]]) -> str:
    return "pin-" + "-".join(f"{label}.{quantity}={value:.3f}" for label, quantity, value in pins)
