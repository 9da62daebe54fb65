"""Upper bound of a refinement gate: each start is run several times, and the other runs predict each run.

A slowdown depends on the situation and on noise. A gate observes only the situation, so the majority of the other runs
of the same start bounds its accuracy.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.tools.evaluations.outcome import Task, Variant
from tailor.tools.evaluations.task_runs import run_all

NOISE_STRIDE = 10_000_000  # between the noise seeds of two runs; far from all other seeds
N_RUNS = 5  # of every start, greedy and refined


def ceiling_of(
    task: Task, settings: RefinementSettings, seeds: range, jobs: int, store: Path | None
) -> dict[str, float | int]:
    """Accuracy and improvement of a gate that predicts each run from the other runs of its start.

    Args:
      task: The world.
      settings: Of refinement, without a gate.
      seeds: Of the starts.
      jobs: Processes.
      store: Folder of finished runs.
    """
    variants = [
        Variant(f"h{h}-{k}", replace(settings, horizon=h), noise=k * NOISE_STRIDE)
        for k in range(N_RUNS)
        for h in (1, 2)
    ]
    found = run_all(task, variants, seeds, jobs, store, "other noise")
    runs = np.full((2, len(seeds), N_RUNS), np.nan)
    for k in range(N_RUNS):
        for way, h in enumerate((1, 2)):
            for place, seed in enumerate(seeds):
                outcome = found[f"h{h}-{k}"][seed]
                runs[way, place, k] = outcome.duration_s if outcome.achieved else np.nan
    whole = np.isfinite(runs).all(axis=(0, 2))
    return judged(runs[0, whole], runs[1, whole])


def judged(greedy_s: NDArray[np.float64], refined_s: NDArray[np.float64]) -> dict[str, float | int]:
    """Figures of durations, shape (starts, runs); runs of one column share their noise."""
    slower = refined_s > greedy_s
    others = (slower.sum(axis=1, keepdims=True) - slower) / (slower.shape[1] - 1)
    kept = others > 0.5
    taken_s = np.where(kept, greedy_s, refined_s)
    return {
        "repeated_starts": len(slower),
        "ceiling_right_pct": 100 * float(np.mean(kept == slower)),
        "repeated_always_right_pct": 100 * float(np.mean(~slower)),
        "ceiling_improvement_pct": 100 * float(np.mean(1 - taken_s / greedy_s)),
        "repeated_improvement_pct": 100 * float(np.mean(1 - refined_s / greedy_s)),
        "mostly_slower_starts_pct": 100 * float(np.mean(slower.mean(axis=1) > 0.5)),
    }
