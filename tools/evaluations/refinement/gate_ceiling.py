"""What no gate can beat: starts run again and again with other noise, judged by one who knows the other runs.

Whether refining slows an episode depends on the situation, and on luck. A gate sees the situation alone; one that knew
how the same start went with other luck would know all that there is to know of it.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.tools.evaluations.outcome import Task, Variant
from tailor.tools.evaluations.task_runs import run_all

LUCK = 10_000_000  # between the noise of one run and the next; far from all other seeds
RUNS = 5  # of every start, both ways


def foreknown(
    task: Task, settings: RefinementSettings, seeds: range, jobs: int, store: Path | None
) -> dict[str, float | int]:
    """How often one who knows the other runs of a start is right about this one, and what that gains.

    Args:
      task: The world.
      settings: Of refinement, without a gate.
      seeds: Of the starts.
      jobs: Processes.
      store: Folder of finished episodes.
    """
    variants = [Variant(f"h{h}-{k}", replace(settings, horizon=h), noise=k * LUCK) for k in range(RUNS) for h in (1, 2)]
    found = run_all(task, variants, seeds, jobs, store, "other luck")
    runs = np.full((2, len(seeds), RUNS), np.nan)
    for k in range(RUNS):
        for way, h in enumerate((1, 2)):
            for place, seed in enumerate(seeds):
                outcome = found[f"h{h}-{k}"][seed]
                runs[way, place, k] = outcome.duration_s if outcome.achieved else np.nan
    whole = np.isfinite(runs).all(axis=(0, 2))
    return judged(runs[0, whole], runs[1, whole])


def judged(greedy_s: NDArray[np.float64], refined_s: NDArray[np.float64]) -> dict[str, float | int]:
    """Figures of durations of shape (starts, runs), run for run with the same noise."""
    slower = refined_s > greedy_s
    others = (slower.sum(axis=1, keepdims=True) - slower) / (slower.shape[1] - 1)
    kept = others > 0.5
    taken_s = np.where(kept, greedy_s, refined_s)
    return {
        "luck_starts": len(slower),
        "foreknown_right_pct": 100 * float(np.mean(kept == slower)),
        "luck_always_right_pct": 100 * float(np.mean(~slower)),
        "foreknown_improvement_pct": 100 * float(np.mean(1 - taken_s / greedy_s)),
        "luck_improvement_pct": 100 * float(np.mean(1 - refined_s / greedy_s)),
        "mostly_slower_starts_pct": 100 * float(np.mean(slower.mean(axis=1) > 0.5)),
    }
