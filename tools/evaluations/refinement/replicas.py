"""Replicas: models trained anew from other episodes, to measure the influence of training on a result."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.progress import Progress
from scipy import stats

from tailor.executive import domains
from tailor.schemas.installed.source import episodes_sha256
from tailor.tools.cli.number_checks import at_least
from tailor.tools.evaluations.paired_comparison import mean_interval, p_shown
from tailor.tools.learning import gathering, run_gathering
from tailor.tools.learning.training_request import TrainingRequest
from tailor.tools.learning.training_run import train_models

RANDOM_ZOO = "zoo-random"  # models before the on-policy round, beside those after it
FIRST_SEED = 5_000  # of gathering and training; what ships is gathered with small ones


@dataclass(frozen=True, slots=True)
class Recipe:
    """How a replica is made.

    Attributes:
      domain: Name of the domain.
      scenarios: Of the on-policy round.
      episodes: Random ones of each action.
      runs: Of the on-policy round, a scenario; 0: none.
    """

    domain: str
    scenarios: tuple[str, ...]
    episodes: int
    runs: int

    @property
    def robot(self) -> str:
        """Name of the domain's robot."""
        return domains.load(self.domain).robot


def configure_replicas(parser: argparse.ArgumentParser) -> None:
    """The flags of evaluations that train models of their own."""
    parser.add_argument("--models", type=at_least(0, "--models"), default=0, metavar="K",
                        help="judge K models more, each gathered for and trained anew, and their mean")  # fmt: skip
    parser.add_argument("--model-episodes", type=at_least(40, "--model-episodes"), default=3000, metavar="N",
                        help="random episodes an action for each of them (default %(default)s)")  # fmt: skip
    parser.add_argument("--model-runs", type=at_least(0, "--model-runs"), default=200, metavar="N",
                        help="runs a scenario of its on-policy round (default %(default)s; 0: none)")  # fmt: skip


def replica(recipe: Recipe, number: int, store: Path, jobs: int) -> Path:
    """A zoo with models trained on episodes that no other replica has seen; made at the first call, found at the next.

    A call that was broken off goes on where it stopped.

    Args:
      recipe: What goes into it.
      number: Which one, from 1.
      store: Folder for all replicas; other controllers or bodies, other replicas.
      jobs: Processes.
    """
    made_by = episodes_sha256(recipe.domain)[:12]
    folder = (
        store
        / "replicas"
        / "-".join([recipe.robot, *recipe.scenarios, str(recipe.episodes), str(recipe.runs), made_by])
        / str(number)
    )
    seed = FIRST_SEED + number
    _gather(recipe, seed, folder / "random", jobs)
    zoo = _trained(recipe, seed, folder / RANDOM_ZOO, [folder / "random"])
    if not recipe.runs:
        return zoo
    policy = run_gathering.Policy(recipe.domain, recipe.scenarios, recipe.runs, seed, str(zoo), folder / "policy")
    _finish(run_gathering.run_policy(policy, jobs), f"model {number}: on-policy")
    return _trained(recipe, seed, folder / "zoo", [folder / "random", folder / "policy"])


def _gather(recipe: Recipe, seed: int, folder: Path, jobs: int) -> None:
    for action in run_gathering.modelled_actions(recipe.domain):
        spec = gathering.DataSetSpec(recipe.domain, action, recipe.episodes, seed, folder / action)
        gathering.prepare(spec, resume=True)
        _finish(gathering.gather(spec, gathering.missing_parts(spec), jobs), f"{action}, seed {seed}")


def _finish(running: Any, title: str) -> None:
    with Progress(transient=True, console=Console(stderr=True)) as progress:
        for _ in progress.track(running, total=None, description=title):
            pass


def _trained(recipe: Recipe, seed: int, zoo: Path, data: list[Path]) -> Path:
    """Train as `tailor train` does, unless that has been done."""
    whole = zoo / "whole"  # written last
    if not whole.exists():
        with Console(stderr=True).status(f"training in {zoo}"):
            train_models(TrainingRequest(recipe.robot, zoo, data=tuple(data), seed=seed))
        whole.touch()
    return zoo


def over_models(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """A row for each scenario and horizon over several models, each judged from starts of its own.

    Its unit is the set of models: the mean of their improvements, with a 95 % interval over them.
    """
    groups: dict[tuple[str, int], list[dict[str, Any]]] = {}
    for row in rows:
        groups.setdefault((row["scenario"], row["horizon"]), []).append(row)
    return [_over(some) for some in groups.values() if len(some) > 1]


def _over(rows: list[dict[str, Any]]) -> dict[str, Any]:
    gains = np.array([row["improvement_pct"] for row in rows])
    means = [key for key in rows[0] if key.startswith("mean_") or key.endswith(("_greedy", "_refined"))]
    return {
        "scenario": rows[0]["scenario"],
        "model": f"{len(rows)} sets of models",
        "horizon": rows[0]["horizon"],
        "n": sum(row["n"] for row in rows),
        "unit": "set of models",
        "units": len(rows),
        "improvement_pct": float(gains.mean()),
        "ci95": mean_interval(gains),
        "p_value": p_shown(float(stats.ttest_1samp(gains, 0.0).pvalue)),
        "least_pct": float(gains.min()),
        "most_pct": float(gains.max()),
        "slower_pct": float(np.mean([row["slower_pct"] for row in rows])),
        **{key: float(np.mean([row[key] for row in rows])) for key in means},
    }
