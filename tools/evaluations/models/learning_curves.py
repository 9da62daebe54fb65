"""Learning curves of the gain: what refinement gains against how many episodes the models learned from, and which.

Random episodes against half of them chosen by the optimiser (on-policy), or half of those choices on which the models
disagree most (active). Every point is the mean over sets of models, each gathered for and trained anew.
"""

from __future__ import annotations

import argparse
import hashlib
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, cast

import numpy as np

from tailor.executive import domains
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.errors import UsageError
from tailor.schemas.installed.source import runs_sha256
from tailor.tools.cli.number_checks import add_count, at_least
from tailor.tools.cli.output_files import whole_output
from tailor.tools.evaluations.dependencies import FIGURES, hashes_of
from tailor.tools.evaluations.models import model_rows
from tailor.tools.evaluations.outcome import FIRST_SEED, Task, Variant
from tailor.tools.evaluations.pages.plots import draw_curves
from tailor.tools.evaluations.pages.report import Report, configure_report, publish_report
from tailor.tools.evaluations.paired_comparison import compare, mean_interval
from tailor.tools.evaluations.task_runs import paired, run_all
from tailor.tools.learning.fresh_seeds import DIGITS
from tailor.tools.learning.making.making import CHOOSING, Making
from tailor.tools.learning.making.steps import make
from tailor.tools.learning.recipe import Recipe, Round
from tailor.tools.learning.recipe_file import recipe_of
from tailor.tools.parallel.steps import show

BESIDE = 40  # runs beside objects: too few for a good model, enough to start; the scenario needs no objects
FIRST_RECIPE_SEED = 6_000  # of gathering; what ships and what replicas learn from has smaller ones
METHODS = ("random", "on-policy", "active")
EPISODES, QUICK_EPISODES = (100, 300, 1000, 3000), (100, 300)
SETS, QUICK_SETS = 5, 2
STARTS, QUICK_STARTS = 100, 20
POOL = 4
DEFAULT = RefinementSettings()
GREEDY, REFINED = Variant("h1", replace(DEFAULT, horizon=1)), Variant("h2", DEFAULT)
REMARKS = (
    "episodes: most of each action; on-policy: half random, half from runs of the scenario with the models of the "
    "random half; active: that half from choices on which these models disagree most",
    "improvement: refined over greedy with the same models; 95 % interval over sets of models, each learned anew; all "
    "sets are judged from the same starts; without gain: sets whose models reached the goal both ways from fewer than "
    "two starts, which count in failed and error alone; error: mean absolute, of the mean duration, on fresh random "
    "episodes",
)


@dataclass(frozen=True, slots=True)
class Point:
    """One way of gathering with one number of episodes."""

    method: str
    episodes: int

    def recipe(self, shipped: Recipe, scenario: str, seed: int) -> Recipe:
        """Recipe of a set of models; learned as those that ship."""
        half = 0 if self.method == "random" else self.episodes // 2
        rounds = (Round(cast("Any", self.method), (scenario,), half, POOL),) if half else ()
        plain = replace(shipped, random=(), uncertain=(), calibration=(), beside=min(shipped.beside, BESIDE))
        training = replace(shipped.training, seed=seed)
        return replace(plain, episodes=self.episodes - half, seed=seed, rounds=rounds, training=training)


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate learning-curves`."""
    add = parser.add_argument
    add("--scenario", default="", help="scenario of the domain (default: its first)")
    add("--episodes", nargs="+", type=at_least(80, "--episodes"), help=f"of each action (default {EPISODES})")
    add("--methods", nargs="+", choices=METHODS, default=list(METHODS), help="ways of gathering (default: all)")
    add("--sets", type=at_least(2, "--sets"), help=f"sets of models of each point (default {SETS})")
    add("--starts", type=at_least(2, "--starts"), help=f"pairs of runs of each set (default {STARTS})")
    add_count(parser, "--fresh", 20, 200, "random episodes to test on")
    add("--quick", action="store_true", help=f"{QUICK_EPISODES} episodes, {QUICK_SETS} sets, {QUICK_STARTS} starts")
    configure_report(parser)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; exit code 0. Resumes where it was interrupted."""
    if not arguments.domain:
        raise UsageError("no domain named, expected --domain NAME")
    domain = arguments.domain
    _check(arguments)
    quick = arguments.quick
    episodes = arguments.episodes or (QUICK_EPISODES if quick else EPISODES)
    settings = argparse.Namespace(
        **{
            **vars(arguments),
            "scenario": arguments.scenario or domains.scenarios(domain)[0],
            "sets": arguments.sets or (QUICK_SETS if quick else SETS),
            "starts": arguments.starts or (QUICK_STARTS if quick else STARTS),
            "seed": arguments.seed if arguments.seed is not None else _first_seed(domain),
        }
    )
    points = [Point(method, count) for count in dict.fromkeys(episodes) for method in dict.fromkeys(arguments.methods)]
    found: dict[Point, list[dict[str, float]]] = {point: [] for point in points}
    for number in range(1, settings.sets + 1):  # whole curves first: a later call with more sets finds these again
        for point in points:
            found[point].append(_figures(point, number, settings))
    rows = [_row(point, found[point], settings.starts) for point in points]
    plots = {}
    if arguments.report is not None:
        path = arguments.report / "learning-curves.png"
        plots["improvement over episodes"] = draw_curves(dict(_curves(rows)), path)
    title = f"Learning curves of the gain: {domain}, {settings.scenario}"
    about = {"first_seed": settings.seed, "seed_derived": arguments.seed is None, "source_sha256": runs_sha256(domain)}
    provenance = {**about, "models_sha256": "of each set its own"}
    publish_report(Report("learning-curves", title, rows, REMARKS, plots, provenance), arguments)
    return 0


def _check(arguments: argparse.Namespace) -> None:
    """Raise UsageError for flags that would be found wrong after hours of training, or without effect."""
    if arguments.zoo:
        raise UsageError(f"--zoo is {arguments.zoo}, expected none: learning-curves trains every model that it judges")
    known = domains.scenarios(arguments.domain)
    if arguments.scenario and arguments.scenario not in known:
        raise UsageError(f"--scenario {arguments.scenario}: no such scenario, expected one of {', '.join(known)}")


def _first_seed(domain: str) -> int:
    """First start, from the source alone: all sets of models are judged from the same starts."""
    return FIRST_SEED + int(runs_sha256(domain)[:DIGITS], 16)


def _row(point: Point, sets: Sequence[dict[str, float]], starts: int) -> dict[str, Any]:
    """Means over the sets that have a figure: one whose models hardly ever reach the goal has no gain."""
    keys = max(sets, key=len)
    values = {key: np.array([figures[key] for figures in sets if key in figures]) for key in keys}
    gains = values.pop("improvement_pct", np.array([]))
    return {
        "gathered": point.method,
        "episodes": point.episodes,
        "sets": len(sets),
        "n": starts * len(sets),
        "without_gain": len(sets) - len(gains),
        "improvement_pct": float(gains.mean()) if len(gains) else float("nan"),
        "ci95": mean_interval(gains),
        **{key: float(found.mean()) for key, found in values.items()},
    }


def _figures(point: Point, number: int, settings: argparse.Namespace) -> dict[str, float]:
    """What one set of models gains, and how far it errs; found again if it was measured before."""
    robot = domains.load(settings.domain).robot
    shipped = recipe_of(robot)
    recipe = point.recipe(shipped, settings.scenario, FIRST_RECIPE_SEED + number)
    work = settings.store / "learning-curves" / str(recipe.episodes)
    making = Making(robot, recipe, work, settings.jobs, "tailor evaluate learning-curves", CHOOSING)
    title = f"{point.method} {point.episodes}, set {number}: "
    measured = f"{settings.scenario}-{settings.seed}-{settings.starts}-{settings.fresh}-{_measured_by()}"
    path = making.rounds / f"figures-{measured}.json"  # its folder stands for source and recipe
    if path.exists():
        known: dict[str, float] = json.loads(path.read_text())
        return known
    show(make(making), settings.json, {}, title)
    figures = _measured(making, title, settings)
    with whole_output(path) as whole:  # an interrupted write would end every later call
        whole.write_text(json.dumps(figures))
    return figures


def _measured_by() -> str:
    """Hash of the source that measures a set of models: that of learners and executive is in the folder's name."""
    return hashlib.sha256(" ".join(hashes_of(FIGURES)).encode()).hexdigest()[:12]


def _measured(making: Making, title: str, settings: argparse.Namespace) -> dict[str, float]:
    task = Task(settings.domain, settings.scenario, zoo=str(making.zoo))
    seeds = range(settings.seed, settings.seed + settings.starts)
    runs = run_all(task, (GREEDY, REFINED), seeds, settings.jobs, settings.store, title)
    times_s = np.array(paired(runs[GREEDY.name], runs[REFINED.name]))
    failed = {"failed_pct": 100 * (1 - times_s.shape[1] / settings.starts), **_errors(settings, making.zoo)}
    greedy_s, refined_s = times_s[:, np.isfinite(times_s).all(axis=0)]  # without starts at which the goal holds
    if len(greedy_s) < 2:  # models of few episodes may hardly ever reach the goal: no gain, and no end of all curves
        return failed
    gain = compare(greedy_s, refined_s)
    return {
        "improvement_pct": gain.improvement_pct,
        "mean_greedy_s": gain.mean_baseline_s,
        "mean_refined_s": gain.mean_s,
        "slower_pct": gain.slower_pct,
        **failed,
    }


def _errors(settings: argparse.Namespace, zoo: Path) -> dict[str, float]:
    """Mean over the actions of errors on fresh random episodes; missed failures if failures are learned."""
    flags = {**vars(settings), "zoo": str(zoo), "episodes": settings.fresh}
    made = model_rows.rows(settings.domain, argparse.Namespace(**flags), floors=False)
    columns = {"error_pct": "relative_pct", "missed_failures_pct": "missed_failures_pct"}
    return {
        name: float(np.mean([row[key] for row in made if key in row]))
        for name, key in columns.items()
        if any(key in row for row in made)
    }


def _curves(rows: Sequence[dict[str, Any]]) -> Iterator[tuple[str, list[tuple[float, float, float, float]]]]:
    """Points of each way of gathering: episodes, improvement, and its interval."""
    for method in dict.fromkeys(row["gathered"] for row in rows):
        mine = [row for row in rows if row["gathered"] == method and row["without_gain"] < row["sets"]]
        if mine:
            yield method, [(row["episodes"], row["improvement_pct"], *row["ci95"]) for row in mine]
