"""Paired episodes that train the refinement gate: each start is run greedy and refined with the same noise."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.models.training.gate_training import Pairs
from tailor.schemas.errors import UsageError
from tailor.tools.evaluations import task_runs
from tailor.tools.evaluations.outcome import FIRST_SEED, Outcome, Task, Variant

Sequences = tuple[tuple[str, ...], ...]


@dataclass(frozen=True, slots=True)
class GatheredPairs:
    """Pairs to learn from, and where they come from.

    Attributes:
      pairs: The usable pairs.
      sequences: Kinds of action sequences that were compared: names of actions, asserted subgoals left out.
      started: Number of pairs of episodes that were run.
    """

    pairs: Pairs
    sequences: Sequences
    started: int


def training_seeds(first: int, count: int) -> range:
    """The seeds of `count` starts.

    Raises:
      UsageError: One of them is reserved for evaluation.
    """
    end = first + count
    if not 0 <= first < end <= FIRST_SEED:
        last = FIRST_SEED - 1
        raise UsageError(
            f"seeds {first}..{end - 1}: seeds above {last} are reserved for evaluation; expected 0..{last}"
        )
    return range(first, end)


def gather_pairs(task: Task, settings: RefinementSettings, seeds: range, jobs: int, store: Path) -> GatheredPairs:
    """Run every start greedy and refined.

    Args:
      task: Domain and scenario.
      settings: Settings of refinement; the horizon is set here.
      seeds: One per start, see `training_seeds`.
      jobs: Number of processes.
      store: Folder of finished episodes; those found there are not run again.
    """
    variants = [Variant(f"h{h}", replace(settings, horizon=h)) for h in (1, 2)]
    outcomes = task_runs.run_all(task, variants, seeds, jobs, store, "greedy and refined")
    both = [(outcomes["h1"][seed], outcomes["h2"][seed]) for seed in seeds]
    return GatheredPairs(pairs_of(both), _sequences(refined for _, refined in both), len(both))


def pairs_of(outcomes: Sequence[tuple[Outcome, Outcome]]) -> Pairs:
    """The pairs (greedy, refined) in which both reached the goal and the two choices could be compared."""
    usable = [(g, r) for g, r in outcomes if g.achieved and r.achieved and r.situation]
    return Pairs(
        np.array([refined.situation for _, refined in usable]),
        np.array([greedy.duration_s for greedy, _ in usable]),
        np.array([refined.duration_s for _, refined in usable]),
    )


def _sequences(outcomes: Iterable[Outcome]) -> Sequences:
    """The kinds of sequences that were compared: names of actions within the horizon, asserted subgoals left out."""
    kinds = {
        tuple(name for name, asserted, _ in outcome.predicted_actions if not asserted)[:2]
        for outcome in outcomes
        if outcome.situation
    }
    return tuple(sorted(kinds))
