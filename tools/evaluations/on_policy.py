"""What episodes of the optimiser's own choices change: error and coverage where it goes, before and after a round."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from models import scores
from models.episodes import Episode, merge, read_data_set
from models.examples import duration_examples, split
from models.features import SPACES
from models.training import fit
from tools import gathering
from tools.evaluations.learned import configure_learned
from tools.evaluations.report import Report, tell
from tools.run_gathering import Policy, actions, run_policy

LEVEL = 0.9
SCENARIOS = ["approach-dribble", "waypoints"]
ROUND_SEED, FRESH_SEED = 1, 2  # of the runs to learn from, and of those to judge by


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate on-policy`."""
    configure_learned(parser, 80)
    parser.add_argument("--data", type=Path, help="random episodes (default: data/ROBOT)")
    parser.add_argument(
        "--scenarios", nargs="+", default=["approach-dribble", "waypoints"], help="(default %(default)s)"
    )
    parser.add_argument("--ticks", type=int, default=2, help="first ticks of each episode (default %(default)s)")


def run(arguments: argparse.Namespace) -> int:
    """Gather both rounds, compare, tell; exit code 0."""
    domain = gathering.domain_of(arguments.robot)
    folders = [_gathered(domain, seed, arguments) for seed in (ROUND_SEED, FRESH_SEED)]
    rows = [row for action in actions(domain) for row in _rows(action, folders, arguments)]
    remarks = ["coverage: share of errors within the interval that holds 90 % on held-out random episodes"]
    tell(Report("on-policy", "One on-policy round", rows, remarks), arguments.json, arguments.report)
    return 0


def _gathered(domain: str, seed: int, arguments: argparse.Namespace) -> Path:
    folder = arguments.store / "policy" / f"{gathering.source_hash(arguments.robot, domain)[:12]}-{seed}"
    policy = Policy(domain, tuple(arguments.scenarios), arguments.episodes, seed, arguments.zoo, folder)
    for _ in run_policy(policy, arguments.jobs):
        pass
    return Path(folder)


def _rows(action: str, folders: Sequence[Path], arguments: argparse.Namespace) -> list[dict[str, Any]]:
    random = read_data_set((arguments.data or Path("data") / arguments.robot) / action)
    chosen, fresh = (read_data_set(folder / action) for folder in folders)
    kept, apart = split(np.arange(len(random.episodes)), 0.25, np.random.default_rng(arguments.seed))
    known = [random.episodes[k] for k in kept]
    unseen = [random.episodes[k] for k in apart]
    both = [*known, *(e for e in merge([random, chosen]).episodes if e.number >= len(random.episodes))]
    rows = []
    for name, episodes in (("random", known), ("random and on-policy", both)):
        figures = _judged([e for e in episodes if e.finished], unseen, fresh.episodes, arguments)
        rows.append({"action": action, "learned from": name, "episodes": len(episodes), **figures})
    return rows


def _judged(
    episodes: Sequence[Episode], unseen: Sequence[Episode], fresh: Sequence[Episode], arguments: argparse.Namespace
) -> dict[str, Any]:
    """Errors on random episodes and on those of the optimiser's choices, none of which were learned from."""
    space = SPACES["projective"]
    model = fit("duration", "bag", duration_examples(episodes, arguments.ticks), space, arguments.seed)
    figures: dict[str, Any] = {}
    factor = 1.0
    for name, some in (("random", unseen), ("policy", fresh)):
        rows = duration_examples([e for e in some if e.finished], 1)
        mean, spread = model.predict_spread(space(rows.arguments))
        off = mean - rows.targets
        if name == "random":
            factor = scores.interval_factor(off, spread, LEVEL)
        mae, ci = scores.mean_with_ci(np.abs(off), np.random.default_rng(arguments.seed))
        figures |= {f"{name}_mae_s": mae, f"{name}_ci95": ci, f"{name}_bias_s": float(off.mean())}
        figures[f"{name}_coverage_pct"] = float(100 * np.mean(np.abs(off) <= factor * np.maximum(spread, 1e-3)))
    return figures
