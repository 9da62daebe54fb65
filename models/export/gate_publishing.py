"""Publishes a refinement gate in a zoo: the ONNX file and its card."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tailor.models.cards.card import FORMAT, Card, card_path, identity
from tailor.models.export.onnx_features import add_features, as_columns
from tailor.models.export.onnx_graph import Graph
from tailor.models.export.onnx_trees import add_probability
from tailor.models.export.publishing import GOLDEN, versions
from tailor.models.export.zoo_writer import write_model
from tailor.models.runtime import GATE
from tailor.models.training.gate_training import Pairs, TrainedGate, space


@dataclass(frozen=True, slots=True)
class GateProvenance:
    """Card entries that pairs and training do not hold."""

    robot: str
    names: tuple[str, ...]  # names of the situations' columns
    sequences: tuple[tuple[str, ...], ...]  # kinds of sequences it was trained for, asserted subgoals left out
    models: Mapping[str, str]  # SHA-256 of the action models by "action/kind" that it was trained with
    settings: Mapping[str, Any]  # settings of refinement
    episodes: Mapping[str, Any]  # provenance of the pairs
    learner: str
    seed: int
    command: str  # reproduces the model


def publish_gate(zoo: Path, pairs: Pairs, trained: TrainedGate, provenance: GateProvenance) -> Path:
    """Write `zoo/robot/refinement/benefit.onnx` and its card; returns the ONNX file's path."""
    card = _card(pairs, trained, provenance)
    return write_model(zoo, _exported(trained, provenance.names, card), card)


def remove_gate(zoo: Path, robot: str) -> bool:
    """Remove a robot's refinement gate and its card.

    Returns:
      Whether there was one.
    """
    path = zoo / robot / f"{GATE}.onnx"
    existed = path.exists()
    for file in (path, card_path(path)):
        file.unlink(missing_ok=True)
    return existed


def _exported(trained: TrainedGate, names: tuple[str, ...], card: Card) -> bytes:
    """Graph from double `arguments` (n, k) to float `slower` (n,)."""
    graph, columns = Graph(), space(names)
    features = as_columns(graph, add_features(graph, columns, "arguments"))
    slower = add_probability(graph, features, trained.trees.steps)
    return bytes(graph.model(len(columns.arguments), {"slower": slower}, identity(card)).SerializeToString())


def _card(pairs: Pairs, trained: TrainedGate, provenance: GateProvenance) -> dict[str, Any]:
    action, kind = GATE.split("/")
    columns = space(provenance.names)
    low, high = pairs.situations.min(axis=0), pairs.situations.max(axis=0)
    content = np.ascontiguousarray(np.column_stack([pairs.situations, pairs.greedy_s, pairs.refined_s]))
    return {
        "format": FORMAT,
        "robot": provenance.robot,
        "action": action,
        "kind": kind,
        "features": columns.name,
        "feature_units": {quantity.name: quantity.unit for quantity in columns.features},
        "arguments": [
            {"name": q.name, "unit": q.unit, "lower": float(a), "upper": float(b)}
            for q, a, b in zip(columns.arguments, low, high, strict=True)
        ],
        "outputs": ["slower"],
        "output_range": [0.0, 1.0],
        "threshold": trained.threshold,
        "sequences": [list(names) for names in provenance.sequences],
        "models": dict(provenance.models),
        "settings": dict(provenance.settings),
        "episodes": {
            **provenance.episodes,
            "count": len(pairs.slower),
            "sha256": hashlib.sha256(content.tobytes()).hexdigest(),
        },
        "learner": {"name": provenance.learner, "leaves": trained.trees.leaves, "seed": provenance.seed},
        "test": trained.test,
        "rules": list(trained.rules),
        "golden": _golden(pairs, trained),
        "versions": versions(),
        "command": provenance.command,
    }


def _golden(pairs: Pairs, trained: TrainedGate) -> dict[str, Sequence[Any]]:
    """Situations spread over the pairs, and the learner's predictions."""
    chosen = np.linspace(0, len(pairs.slower) - 1, GOLDEN).astype(int)
    situations = pairs.situations[chosen]
    risk = np.round(trained.trees.risk(situations), 6)
    return {"arguments": situations.tolist(), "slower": risk.tolist()}
