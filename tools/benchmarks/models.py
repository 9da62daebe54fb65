"""Time of a prediction, features included, in microseconds, and of a fit in seconds."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from tailor.executive.interfaces.values import Array
from tailor.models.cards.card import Card
from tailor.models.export.onnx_export import export_duration
from tailor.models.features.planar import projective
from tailor.models.inference import open_session
from tailor.models.rules.model_queries import random_arguments
from tailor.models.runtime import load_robot
from tailor.models.training import learners
from tailor.models.trees.model_tree import BaggedModelTrees

Predict = Callable[[Array], object]  # of arguments, shape (n, k)
BATCHES = (1, 50, 250, 1000)
LEARNERS: Mapping[str, Callable[[], Any]] = {
    "one tree": lambda: learners.make_learner("duration", "linear", 1),
    "bag of 16": lambda: BaggedModelTrees(trees=16, random_state=1),
}
EPISODES, TICKS = 3000, 20  # docs/learning.md limits this fit to 5 s


def run(console: Console, quick: bool) -> None:
    """Print both tables."""
    durations, successes = load_robot("agilo")
    table = Table("model", *(f"n = {count}" for count in BATCHES), title="prediction of n inputs with features, µs")
    loaded: dict[str, tuple[Predict, Card]] = {name: (model.predict, model.card) for name, model in durations.items()}
    loaded |= {name: (model.probability, model.card) for name, model in successes.items()}
    for name, (predict, card) in loaded.items():
        table.add_row(f"agilo/{name} ({card['learner']['name']})", *_times(predict, card, quick))
    card = durations["goToPose/duration"].card
    for name, make in LEARNERS.items():
        predict, leaves = _runtime_alone(make)
        table.add_row(f"{name} ({leaves} leaves), ONNX runtime alone", *_times(predict, card, quick))
    console.print(table)
    console.print(f"fit of one tree, {EPISODES} episodes x {TICKS} ticks: {_fit_seconds():.1f} s")


def _times(predict: Predict, card: Card, quick: bool) -> list[str]:
    """Minimum over many short repetitions: each fits between two interruptions by other processes."""
    arguments = random_arguments(card, max(BATCHES), np.random.default_rng(0))
    cells = []
    for count in BATCHES:
        batch, best = np.ascontiguousarray(arguments[:count]), np.inf
        for _ in range(100 if quick else 1000):
            started = time.perf_counter()
            predict(batch)
            predict(batch)
            best = min(best, (time.perf_counter() - started) / 2)
        cells.append(f"{1e6 * best:.1f}")
    return cells


def examples(count: int) -> tuple[NDArray[np.float32], Array, NDArray[np.intp]]:
    """Features, seconds and episode numbers of a synthetic task: waves and a fold, which need many leaves."""
    rng = np.random.default_rng(0)
    features = rng.uniform([0, 0, 0, 0, -3], [0.6, 0.6, 6, 3, 3], (count, 5)).astype(np.float32)
    v, _, dist, to, at = features.T
    seconds = 1 + 1.6 * dist + 0.6 * np.abs(at) + 3 * v * np.sin(3 * dist) + np.cos(4 * at) + np.where(to > 1, at, 0)
    return features, seconds + rng.normal(0, 0.3, count), np.arange(count) // TICKS


def _runtime_alone(make: Callable[[], Any]) -> tuple[Predict, int]:
    """Call of a learner's graph without the checks of `tailor.models.runtime`, and its number of leaves."""
    features, seconds, groups = examples(20_000)
    learner = make().fit(features, seconds, groups=groups)
    session = open_session(export_duration(learner, projective, {}).SerializeToString())
    leaves = sum(tree.leaves for tree in learner.trees_)
    return lambda arguments: session.run(None, {"arguments": arguments}), leaves


def _fit_seconds() -> float:
    """CPU seconds of the fit of one tree."""
    features, seconds, groups = examples(EPISODES * TICKS)
    started = time.process_time()
    learners.make_learner("duration", "linear", 1).fit(features, seconds, groups=groups)
    return time.process_time() - started
