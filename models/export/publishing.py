"""Publishes a trained model in a zoo: the ONNX file and its card."""

from __future__ import annotations

import platform
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import onnx
from numpy.typing import NDArray

from tailor.models.cards.card import FORMAT, SUCCESS_KINDS, Card, identity
from tailor.models.episodes.episodes import DataSet
from tailor.models.episodes.regression_targets import REGRESSION_TARGETS
from tailor.models.episodes.sources import CALIBRATES
from tailor.models.export.onnx_export import export_duration, export_success
from tailor.models.export.zoo_writer import write_model
from tailor.models.features.features import FeatureSpace
from tailor.models.training.training import Trained

Array = NDArray[np.float64]
GOLDEN = 32  # examples in a card
MAX_FACTOR = 3.0  # predictions above three times the longest episode, or its energy, are invalid
ROUNDING = 1e-5  # s or J: more than graph and learner differ by,
ROUNDING_SHARE = 1e-6  # or this of the largest mean, if that is more
LIBRARIES = ("numpy", "onnx", "onnxruntime", "scikit-learn", "tailor")


@dataclass(frozen=True, slots=True)
class Publication:
    """Card entries that data set and training do not hold."""

    kind: str  # one of `card.KINDS`
    learner: str
    space: FeatureSpace
    seed: int
    command: str  # reproduces the model


def publish(zoo: Path, data: DataSet, trained: Trained, about: Publication) -> Path:
    """Write `zoo/robot/action/kind.onnx` and its card.

    Args:
      zoo: Folder of models.
      data: Episodes that the model was trained on.
      trained: The model.
      about: Further entries of the card.

    Returns:
      Path of the ONNX file.

    Raises:
      TypeError: The learner cannot be exported.
      OSError: The files cannot be written.
    """
    card = _card(data, trained, about)
    return write_model(zoo, _exported(trained.learner, about, card).SerializeToString(), card)


def _exported(learner: Any, about: Publication, card: Card) -> onnx.ModelProto:
    if about.kind in SUCCESS_KINDS:
        return export_success(learner, about.space, identity(card))
    return export_duration(learner, about.space, identity(card), REGRESSION_TARGETS[about.kind].unit)


def _outputs(kind: str) -> list[str]:
    """Names of the graph's outputs."""
    if kind in SUCCESS_KINDS:
        return ["success"]
    return [f"{name}_{REGRESSION_TARGETS[kind].unit}" for name in ("mean", "lower", "upper")]


def _output_range(data: DataSet, kind: str) -> list[float]:
    """Range outside of which predictions are invalid."""
    if kind in SUCCESS_KINDS:
        return [0.0, 1.0]
    return [0.0, MAX_FACTOR * max(REGRESSION_TARGETS[kind].whole(episode) for episode in data.episodes)]


def _card(data: DataSet, trained: Trained, about: Publication) -> dict[str, Any]:
    manifest = data.manifest
    return {
        "format": FORMAT,
        "robot": manifest["robot"],
        "action": manifest["action"],
        "kind": about.kind,
        "features": about.space.name,
        "feature_units": {feature.name: feature.unit for feature in about.space.features},
        "arguments": manifest["arguments"],
        "outputs": _outputs(about.kind),
        "output_range": _output_range(data, about.kind),
        **({"threshold": trained.learner.threshold_} if about.kind in SUCCESS_KINDS else {}),
        "episodes": _episodes(data),
        "learner": _learner(trained, about),
        "test": trained.test,
        "golden": golden(data, trained.learner, about),
        "versions": versions(),
        "command": about.command,
    }


def _episodes(data: DataSet) -> dict[str, Any]:
    """Card entries of the training episodes."""
    return {
        "count": len(data.episodes),
        "finished": sum(episode.finished for episode in data.episodes),
        "on_policy": data.manifest.get("on_policy", 0),
        **({CALIBRATES: data.manifest[CALIBRATES]} if data.manifest.get(CALIBRATES) else {}),
        "sha256": data.sha256,
        **{key: data.manifest[key] for key in ("sources", "source_files", "probe") if data.manifest.get(key)},
    }


def _learner(trained: Trained, about: Publication) -> dict[str, Any]:
    """Card entries of the learner."""
    learner = getattr(trained.learner, "inner_", trained.learner)
    return {
        "name": about.learner,
        **({"weights": learner.weights_} if hasattr(learner, "weights_") else {}),
        "settings": {k: v for k, v in learner.get_params(deep=False).items() if _plain(v)},
        "leaves": leaves(learner),
        "n_i": trained.n_i,
        "seed": about.seed,
    }


def versions() -> dict[str, str]:
    """Versions of Python and of the libraries that a model depends on."""
    return {"python": platform.python_version(), **{name: version(name) for name in LIBRARIES}}


def _plain(value: object) -> bool:
    return value is None or isinstance(value, bool | int | float | str)


def leaves(learner: Any) -> list[int]:
    """Number of leaves of each tree of a learner; empty if it has no trees."""
    if hasattr(learner, "steps_"):
        return [splits.leaves for splits, _ in learner.steps_]
    if hasattr(learner, "members_"):
        return [count for member in learner.members_.values() for count in leaves(member)]
    return [tree.leaves for tree in getattr(learner, "trees_", [])]


def golden(data: DataSet, learner: Any, about: Publication) -> dict[str, Sequence[Any]]:
    """Arguments spread over the episodes, and the learner's predictions.

    The last ones are at zero distance: each `xg` is at its `x`, where the names tell that it is a goal.
    """
    chosen = np.linspace(0, len(data.episodes) - 1, GOLDEN).astype(int)
    arguments = np.round(np.stack([data.episodes[k].arguments for k in chosen]), 6)
    names = data.names
    for start, goal in ((k, names.index(f"{name}g")) for k, name in enumerate(names) if f"{name}g" in names):
        arguments[-1, goal] = arguments[-1, start]
    if about.kind not in SUCCESS_KINDS:
        arguments = _off_thresholds(arguments, learner, about.space)
    features = about.space(arguments)
    if about.kind in SUCCESS_KINDS:
        predictions: Mapping[str, Array] = {"success": learner.predict_proba(features)[:, 1]}
    else:
        predictions = dict(zip(_outputs(about.kind), learner.predict_interval(features), strict=True))
    rounded = {name: np.round(values.astype(np.float64), 6).tolist() for name, values in predictions.items()}
    return {"arguments": arguments.tolist(), **rounded}


def _off_thresholds(arguments: Array, learner: Any, space: FeatureSpace) -> Array:
    """The rows whose interval does not depend on rounding errors of the standard deviation."""
    features = space(arguments)
    mean, std = learner.predict_with_std(features)
    error = max(ROUNDING, ROUNDING_SHARE * float(np.abs(mean).max()))
    ends = [learner.intervals_.around(features, 0.0, std + step)[1] for step in (-error, 0.0, error)]
    return np.asarray(arguments[(ends[0] == ends[1]) & (ends[1] == ends[2])])
