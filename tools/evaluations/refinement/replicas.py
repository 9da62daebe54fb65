"""Replicas: models trained anew from other episodes, to measure the influence of training on a result."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy import stats

from tailor.executive import domains
from tailor.tools.cli.number_checks import at_least
from tailor.tools.evaluations.paired_comparison import mean_interval, p_shown
from tailor.tools.learning.making.making import CHOOSING, Making
from tailor.tools.learning.making.steps import make
from tailor.tools.learning.recipe import Round
from tailor.tools.learning.recipe_file import recipe_of
from tailor.tools.parallel.steps import show

FIRST_SEED = 5_000  # of gathering and training; what ships is gathered with small ones
SEEDS = 20  # of each replica: every round and calibration has the next one


@dataclass(frozen=True, slots=True)
class Recipe:
    """In what replicas differ from the recipe of the robot's models, but for seeds.

    Attributes:
      domain: Name of the domain.
      scenarios: Of the on-policy round.
      episodes: Random ones of each action; `None`: the recipe's.
      runs: Of a single on-policy round, a scenario; 0: no round; `None`: rounds and calibration of the recipe.
    """

    domain: str
    scenarios: tuple[str, ...] = ()
    episodes: int | None = None
    runs: int | None = None

    @property
    def robot(self) -> str:
        """Name of the domain's robot."""
        return domains.load(self.domain).robot


def configure_replicas(parser: argparse.ArgumentParser) -> None:
    """The flags of evaluations that train models of their own."""
    parser.add_argument("--models", type=at_least(0, "--models"), default=0, metavar="K",
                        help="judge K models more, each gathered for and trained anew, and their mean")  # fmt: skip
    parser.add_argument("--model-episodes", type=at_least(40, "--model-episodes"), metavar="N",
                        help="random episodes an action for each of them (default: as the robot's recipe)")  # fmt: skip
    parser.add_argument("--model-runs", type=at_least(0, "--model-runs"), metavar="N",
                        help="runs a scenario of one on-policy round, not the recipe's rounds (0: none)")  # fmt: skip


def replica(recipe: Recipe, number: int, store: Path, jobs: int) -> Making:
    """Models learned as those that ship, from episodes that no other replica has seen; made once.

    A call that was broken off goes on where it stopped. Energies are not learned: while they have no price, no choice
    depends on them.

    Args:
      recipe: What goes into it.
      number: Which one, from 1.
      store: Folder for all replicas; other controllers or bodies, other replicas.
      jobs: Processes.

    Raises:
      UsageError: The robot's models have no recipe, or see `make`.
    """
    shipped = recipe_of(recipe.robot)
    training = replace(shipped.training, seed=FIRST_SEED + SEEDS * number)  # a set differs in all that is drawn
    own, work = replace(shipped, seed=training.seed, training=training), store / "replicas"
    if recipe.episodes is not None:
        work /= str(recipe.episodes)  # a folder of more episodes than are asked for is refused
        own = replace(own, episodes=recipe.episodes, random=(), uncertain=())
    if recipe.runs is not None:
        rounds = (Round("on-policy", recipe.scenarios, recipe.runs),) if recipe.runs else ()
        own = replace(own, rounds=rounds, calibration=())
    making = Making(recipe.robot, own, work, jobs, "tailor evaluate refinement --models", CHOOSING)
    show(make(making), False, {}, f"model {number}: ")
    return making


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
    shared = [key for key in rows[0] if all(key in row for row in rows)]  # a set whose runs all fail lacks some
    totals = np.array([row["total_pct"] for row in rows]) if "total_pct" in shared else None
    means = [key for key in shared if key.startswith("mean_") or key.endswith(("_greedy", "_refined"))]
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
        **({} if totals is None else {"total_pct": float(totals.mean()), "total_ci95": mean_interval(totals)}),
        "slower_pct": float(np.mean([row["slower_pct"] for row in rows])),
        **{key: float(np.mean([row[key] for row in rows])) for key in means},
    }
