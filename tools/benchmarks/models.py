"""Microseconds of a prediction, features included, and seconds of a fit."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from tailor.models.cards.card import Card
from tailor.models.export.onnx_export import export_duration
from tailor.models.features.features import SPACES
from tailor.models.rules.model_queries import random_arguments
from tailor.models.runtime import OnnxDuration, load_robot, open_session
from tailor.models.training import learners
from tailor.models.trees.model_tree import BaggedModelTrees

ROWS = (1, 50, 250, 1000)
ALONE: Mapping[str, Callable[[], Any]] = {
    "one tree": lambda: learners.make_learner("duration", "linear", 1),
    "bag of 16": lambda: BaggedModelTrees(trees=16, random_state=1),
}
EPISODES, TICKS = 3000, 20  # the fit that learning.md sets a limit for: 5 s


def run(console: Console, quick: bool) -> None:
    """Print both tables."""
    durations, successes = load_robot("agilo")
    table = Table("model", *(f"{rows} rows" for rows in ROWS), title="prediction with features, µs")
    for name, model in {**durations, **successes}.items():
        ask = model.predict if isinstance(model, OnnxDuration) else model.probability
        table.add_row(f"agilo/{name} ({model.card['learner']['name']})", *_times(ask, model.card, quick))
    card = durations["goToPose/duration"].card
    for name, learner in ALONE.items():
        ask, leaves = _alone(learner)
        table.add_row(f"{name} ({leaves} leaves), runtime alone", *_times(ask, card, quick))
    console.print(table)
    console.print(f"fit of one tree, {EPISODES} episodes x {TICKS} rows: {_fit_seconds():.1f} s")


def _times(ask: Callable[[Any], Any], card: Card, quick: bool) -> list[str]:
    """Best of many short repetitions: each fits between two interruptions by other processes."""
    arguments = random_arguments(card, max(ROWS), np.random.default_rng(0))
    shown = []
    for rows in ROWS:
        part, best = np.ascontiguousarray(arguments[:rows]), np.inf
        for _ in range(100 if quick else 1000):
            started = time.perf_counter()
            ask(part)
            ask(part)
            best = min(best, (time.perf_counter() - started) / 2)
        shown.append(f"{1e6 * best:.1f}")
    return shown


def _examples(count: int) -> tuple[Any, Any, Any]:
    """Features, seconds and episodes of a task made up for timing: waves and a fold, which need many leaves."""
    rng = np.random.default_rng(0)
    features = rng.uniform([0, 0, 0, 0, -3], [0.6, 0.6, 6, 3, 3], (count, 5)).astype(np.float32)
    v, _, dist, to, at = features.T
    seconds = 1 + 1.6 * dist + 0.6 * np.abs(at) + 3 * v * np.sin(3 * dist) + np.cos(4 * at) + np.where(to > 1, at, 0)
    return features, seconds + rng.normal(0, 0.3, count), np.arange(count) // TICKS


def _alone(make: Callable[[], Any]) -> tuple[Callable[[Any], Any], int]:
    """A learner's graph without what `tailor.models.runtime` adds to a call, and how many leaves it has."""
    features, seconds, groups = _examples(20_000)
    learner = make().fit(features, seconds, groups=groups)
    session = open_session(export_duration(learner, SPACES["projective"], {}).SerializeToString())
    leaves = sum(tree.leaves for tree in learner.trees_)
    return lambda arguments: session.run(None, {"arguments": arguments}), leaves


def _fit_seconds() -> float:
    features, seconds, groups = _examples(EPISODES * TICKS)
    started = time.process_time()
    learners.make_learner("duration", "linear", 1).fit(features, seconds, groups=groups)
    return time.process_time() - started
