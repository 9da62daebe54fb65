"""Noise floors: how much repeated runs of a task differ, which no model of these tasks can predict."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.executive import domains
from tailor.models.episodes.episodes import DataSet
from tailor.tools.evaluations.paired_comparison import ratio_interval
from tailor.tools.learning.gathering import random_episodes
from tailor.tools.learning.gathering.data_set_spec import NOISE_STREAM
from tailor.tools.lockstep import action_run
from tailor.tools.parallel.pool import completed, in_order

Array = NDArray[Any]
REPEATS = 8  # runs of the same task with other noise
# Durations lie nearer to the median of their own eight runs than to the true one: by 1.100 if their errors are normal,
# by 1.074 if Laplacian (200 000 draws of each).
OF_OWN_MEDIAN = 1.087
REPEATED_TASKS = 1000


def floor_columns(row: Mapping[str, Any], data: DataSet, action: tuple[str, str, int, int]) -> dict[str, Any]:
    """Columns of the noise floor, over the first tasks that finished, and of the model's error on the same ones.

    A few hard tasks make most of either, so floor and error of different tasks do not compare.

    Args:
      row: With the model's `predicted_s` and `observed_s`, one for each finished episode.
      data: The fresh episodes.
      action: Robot, action, seed, jobs.
    """
    robot, name, seed, jobs = action
    tasks = np.array([episode.arguments for episode in data.episodes if episode.finished][:REPEATED_TASKS])
    floor_s, alike = noise_floor(robot, name, tasks, seed, jobs)
    off_s = np.abs(row["predicted_s"] - row["observed_s"])[: len(tasks)]
    found: dict[str, Any] = {"noise_floor_s": float(floor_s.mean())}
    if floor_s.any():  # a simulation without noise has none
        found["over_floor"] = float(off_s.mean() / floor_s.mean())
        found["over_floor_ci95"] = ratio_interval(off_s, floor_s, seed)
    if "failure_accuracy_pct" in row:
        found["floor_accuracy_pct"] = float(100 * alike.mean())
    return found


def noise_floor(robot: str, action: str, tasks: Array, seed: int, jobs: int) -> tuple[Array, Array]:
    """Noise floor of any model on each task: repeated runs with other noise.

    Args:
      robot: Name of the robot.
      action: Name of the action.
      tasks: Arguments of the tasks, shape (n, k).
      seed: Of the noise.
      jobs: Processes.

    Returns:
      For each task, shape (n,): mean distance of its durations to their median (s, corrected for the number of runs),
      and the share of runs that end as most of them do. Runs that do not finish have no duration, as for the model.
    """
    wanted = [(robot, action, arguments, seed, number) for number, arguments in enumerate(tasks)]
    runs = in_order(completed(_repeated, wanted, jobs))
    durations, successes = (np.array(column) for column in zip(*runs, strict=True))
    off = np.array([np.abs(some - np.median(some)).mean() if len(some) else 0.0 for some in map(_finite, durations)])
    share = successes.mean(axis=1)
    return off * OF_OWN_MEDIAN, np.maximum(share, 1 - share)


def _repeated(robot: str, action: str, arguments: Array, seed: int, task: int) -> tuple[Array, Array]:
    domain = domains.load(random_episodes.domain_of(robot))
    body = action_run.new_body(domain)
    runs = [
        action_run.run_action(body, domain, action, arguments, np.random.default_rng([NOISE_STREAM, seed, task, k]))
        for k in range(REPEATS)
    ]
    durations_s = [run.duration_s if run.done else np.nan for run in runs]
    return np.array(durations_s), np.array([run.success for run in runs])


def _finite(values: Array) -> Array:
    return values[np.isfinite(values)]
