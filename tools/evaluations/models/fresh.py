"""Fresh episodes to judge models by: drawn from a stream of seeds that training never uses, kept for the next time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.executive import domains
from tailor.models.episodes.episodes import DataSet, read_data_set
from tailor.tools.learning import gathering
from tailor.tools.learning.gathering import EVALUATION_STREAM, NOISE_STREAM, TRAINING_STREAM, DataSetSpec
from tailor.tools.lockstep import action_run

REPEATS = 8  # runs of the same task with other noise
REPEATED_TASKS = 60


def episodes(robot: str, action: str, count: int, seed: int, jobs: int, store: Path, stream: int) -> DataSet:
    """Episodes of an action from a stream of seeds; made at the first call, read at the next.

    Raises:
      UsageError: The robot has no such action.
    """
    domain = gathering.domain_of(robot)
    gathering.check_action(domain, action)
    made_by = gathering.source_hash(robot, domain)[:12]  # other controllers, other episodes
    folder = store / "episodes" / f"{robot}-{action}-{made_by}-{stream}-{seed}-{count}"
    spec = DataSetSpec(domain, action, count, seed, folder, stream)
    gathering.prepare(spec, resume=True)
    for _ in gathering.gather(spec, gathering.missing_parts(spec), jobs):
        pass
    return read_data_set(folder)


def evaluation(robot: str, action: str, count: int, seed: int, jobs: int, store: Path) -> DataSet:
    """Episodes that no model has seen."""
    return episodes(robot, action, count, seed, jobs, store, EVALUATION_STREAM)


def training(robot: str, action: str, count: int, seed: int, jobs: int, store: Path) -> DataSet:
    """Episodes to train on, the same as `tailor gather` makes with that seed."""
    return episodes(robot, action, count, seed, jobs, store, TRAINING_STREAM)


def noise_floor(robot: str, action: str, seed: int, jobs: int) -> dict[str, float]:
    """What no model can beat: the same tasks run again with other noise.

    Returns:
      `mae_s`: mean distance of a duration to the median of its task's; `accuracy_pct`: how often a task ends as it
      mostly does.
    """
    from joblib import Parallel, delayed

    runs = Parallel(n_jobs=jobs)(delayed(_repeated)(robot, action, seed, task) for task in range(REPEATED_TASKS))
    durations, successes = (np.array(column) for column in zip(*runs, strict=True))
    mae = np.abs(durations - np.median(durations, axis=1, keepdims=True)).mean() * REPEATS / (REPEATS - 1)
    share = successes.mean(axis=1)
    return {"mae_s": float(mae), "accuracy_pct": float(100 * np.maximum(share, 1 - share).mean())}


def _repeated(robot: str, action: str, seed: int, task: int) -> tuple[NDArray[Any], NDArray[Any]]:
    domain = domains.load(gathering.domain_of(robot))
    body = action_run.new_body(domain)
    arguments = action_run.sample_arguments(domain, action, np.random.default_rng([NOISE_STREAM, seed, task]))
    runs = [
        action_run.run_action(body, domain, action, arguments, np.random.default_rng([NOISE_STREAM, seed, task, k]))
        for k in range(REPEATS)
    ]
    return np.array([run.duration_s for run in runs]), np.array([run.success for run in runs])
