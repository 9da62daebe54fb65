"""Loads, checks and runs ONNX action models. The only module that imports onnxruntime.

A model is used only if its bytes, its card and its predictions agree: onnxruntime does not detect a flipped bit.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import onnxruntime
from numpy.typing import NDArray

from tailor.models.bounds.interval_boxes import UPPER_SCORE
from tailor.models.bounds.model_bounds import ModelBounds, model_bounds
from tailor.models.cards.card import (
    KINDS,
    MAX_MODEL_BYTES,
    SUCCESS_KINDS,
    Card,
    card_path,
    read_bytes,
    read_card,
    sha256_of,
)
from tailor.models.cards.checks import check_identity, check_place, check_ranges
from tailor.schemas.errors import UsageError

Array = NDArray[np.float64]

ZOO = Path(__file__).resolve().parent / "zoo"
GOLDEN_TOLERANCE = 1e-4  # seconds, joules or probability: the tolerance of export (learning.md)


@dataclass(frozen=True, slots=True)
class OnnxDuration:
    """Predicts the duration of an action in seconds, or its energy in joules; the card holds which.

    Attributes:
      session: Inference session of onnxruntime.
      card: The model's card.
      output_min: Smallest valid mean.
      output_max: Largest valid mean.
      bounds: Bounds of the predictions; None if the model does not consist of trees.
    """

    session: Any
    card: Card
    output_min: float
    output_max: float
    bounds: ModelBounds | None = None

    def predict(self, arguments: Array) -> tuple[Array, Array]:
        """Predict durations or energies.

        Args:
          arguments: Arguments of the action, shape (n, k), in the order and units of the card.

        Returns:
          Mean and standard deviation in seconds (or joules), shapes (n,); NaN where the prediction is invalid. The
          deviation of a model with intervals is that of a normal distribution with the same 95 % quantile.
        """
        mean, *rest = (values.astype(np.float64) for values in self._run(arguments))
        std = (rest[1] - mean) / UPPER_SCORE if self.calibrated else rest[0]
        mean, std = self._valid(mean, (mean, std), std)
        return mean, std

    def interval(self, arguments: Array) -> tuple[Array, Array, Array]:
        """Predict durations or energies with intervals that hold 90 % of them.

        Args:
          arguments: Arguments of the action, shape (n, k), in the order and units of the card.

        Returns:
          Mean, lower and upper end in seconds (or joules), shapes (n,); NaN where the prediction is invalid.
        """
        mean, *rest = (values.astype(np.float64) for values in self._run(arguments))
        half = float(self.card["test"].get("interval90_factor", UPPER_SCORE)) * rest[0]
        lower, upper = rest if self.calibrated else (mean - half, mean + half)
        mean, lower, upper = self._valid(mean, (mean, lower, upper), upper - mean)
        return mean, lower, upper

    @property
    def calibrated(self) -> bool:
        """Whether the graph has intervals of its own, and not only a standard deviation."""
        return len(self.card["outputs"]) == 3

    def _run(self, arguments: Array) -> Any:
        return self.session.run(None, {"arguments": np.ascontiguousarray(arguments, np.float64)})

    def _valid(self, mean: Array, values: tuple[Array, ...], width: Array) -> Any:
        """The values, NaN where the mean is out of range or the width is negative."""
        valid = (mean >= self.output_min) & (mean <= self.output_max) & (width >= 0)
        return values if valid.all() else tuple(np.where(valid, each, np.nan) for each in values)


@dataclass(frozen=True, slots=True)
class OnnxSuccess:
    """Predicts whether an action succeeds.

    Attributes:
      session: Inference session of onnxruntime.
      card: The model's card.
      threshold: Probability of success from which success is predicted, 0..1.
      bounds: Bounds of the predictions; None if the model does not consist of trees.
    """

    session: Any
    card: Card
    threshold: float
    bounds: ModelBounds | None = None

    def probability(self, arguments: Array) -> Array:
        """Predict probabilities of success.

        Args:
          arguments: Arguments of the action, shape (n, k), in the order and units of the card.

        Returns:
          Probabilities, 0..1, shape (n,); NaN where the prediction is invalid.
        """
        return _probability(self.session, arguments)


OnnxModel = OnnxDuration | OnnxSuccess


def load_model(model: Path | str, zoo: Path | None = None) -> OnnxModel:
    """Load and check one model.

    Args:
      model: Path of the ONNX file, or name in the zoo, as "agilo/goToPose/duration".
      zoo: Folder of models, None for the one that ships.

    Raises:
      UsageError: The file or its card is missing or damaged, or they do not agree; the message names both values.
    """
    path = model if isinstance(model, Path) else _in_zoo(model, zoo or ZOO)
    card = read_card(card_path(path))
    content = read_bytes(path, MAX_MODEL_BYTES)
    if sha256_of(content) != card["sha256"]:
        raise UsageError(f"{path}: sha256 is {sha256_of(content)[:12]}…, expected {card['sha256'][:12]}… by its card")
    session = _session(content, path)
    check_identity(session.get_modelmeta().custom_metadata_map, session.get_inputs()[0].shape, card, path)
    bounds = model_bounds(content, str(card["features"]), len(card.get("feature_units", ())))
    loaded = _wrapped(session, card, path, bounds)
    _check_golden(loaded, card, path)
    return loaded


def load_robot(
    robot: str, zoo: Path | None = None, declared: Mapping[str, Mapping[str, tuple[float, float]]] | None = None
) -> tuple[dict[str, OnnxDuration], dict[str, OnnxSuccess]]:
    """Load all models of a robot: durations (and energies) and successes by "action/kind".

    Args:
      robot: Folder in the zoo.
      zoo: Folder of models, None for the one that ships.
      declared: Ranges (lower, upper) that the robot's actions declare, by action and argument; a model that was trained
        on less is refused.

    Returns:
      Models of durations and energies, and models of success.

    Raises:
      UsageError: No such robot in the zoo, or a model fails its checks.
    """
    folder = (zoo or ZOO) / robot
    if not folder.is_dir() or folder.parent != (zoo or ZOO):
        robots = ", ".join(sorted(p.name for p in (zoo or ZOO).glob("*") if p.is_dir())) or "none"
        make = f"`tailor gather {robot}` and `tailor train {robot}` make them"
        raise UsageError(f"no action models for robot '{robot}' in {zoo or ZOO} (robots there: {robots}); {make}")
    durations: dict[str, OnnxDuration] = {}
    successes: dict[str, OnnxSuccess] = {}
    for name in _names(folder):
        model = load_model(folder / f"{name}.onnx")
        check_place(model.card, f"{robot}/{name}", folder)
        check_ranges(model.card, (declared or {}).get(name.split("/", maxsplit=1)[0], {}), folder / name)
        if isinstance(model, OnnxDuration):
            durations[name] = model
        elif isinstance(model, OnnxSuccess):
            successes[name] = model
    return durations, successes


def _names(folder: Path) -> list[str]:
    """Every "action/kind" that has a model or a card; one without the other is an error when loading."""
    files = {f"{p.parent.name}/{p.name.split('.')[0]}" for kind in KINDS for p in folder.glob(f"*/{kind}.*")}
    return sorted(files)


def _in_zoo(name: str, zoo: Path) -> Path:
    parts = name.split("/")
    if len(parts) != 3 or parts[2] not in KINDS or any(part in ("", ".", "..") for part in parts):
        raise UsageError(f"'{name}' names no model (expected ROBOT/ACTION/KIND, KIND one of: {', '.join(KINDS)})")
    return zoo.joinpath(*parts[:2], f"{parts[2]}.onnx")


def open_session(content: bytes) -> Any:
    """Inference session of an ONNX model that starts no threads; exceptions of onnxruntime are not caught."""
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    options.execution_mode = onnxruntime.ExecutionMode.ORT_SEQUENTIAL
    options.enable_mem_reuse = False  # saves 2 us per call: results do not wait for each other's memory
    options.add_session_config_entry("session.intra_op.allow_spinning", "0")
    options.log_severity_level = 3  # errors are raised as exceptions
    return onnxruntime.InferenceSession(content, options, providers=["CPUExecutionProvider"])


def _session(content: bytes, path: Path) -> Any:
    try:
        return open_session(content)
    except Exception as error:  # onnxruntime's exceptions have no common base
        raise UsageError(f"{path}: not a model that onnxruntime can run ({str(error).splitlines()[0]})") from None


def _wrapped(session: Any, card: Card, path: Path, bounds: ModelBounds | None) -> OnnxModel:
    if card["kind"] in ("duration", "energy"):
        output_min, output_max = card["output_range"]
        return OnnxDuration(session, card, float(output_min), float(output_max), bounds)
    if card["kind"] in SUCCESS_KINDS:
        return OnnxSuccess(session, card, float(card["threshold"]), bounds)
    raise UsageError(f"{path}: kind '{card['kind']}' is unknown (expected one of: {', '.join(KINDS)})")


def _probability(session: Any, arguments: Array) -> Array:
    rows = np.ascontiguousarray(arguments, np.float64)
    (probability,) = session.run(None, {"arguments": rows})
    # a tree assigns NaN to some leaf, so the inputs are checked, too
    valid = (probability >= 0) & (probability <= 1) & np.isfinite(rows.sum(axis=1))
    return np.where(valid, probability, np.nan).astype(np.float64)


def _check_golden(model: OnnxModel, card: Card, path: Path) -> None:
    """Compare predictions of the golden examples with the card; also warms up the session."""
    golden = card["golden"]
    arguments = np.array(golden["arguments"], np.float64)
    match model:
        case OnnxDuration():
            predictions: tuple[Array, ...] = model.interval(arguments) if model.calibrated else model.predict(arguments)
        case OnnxSuccess():
            predictions = (model.probability(arguments),)
    for name, values in zip(card["outputs"], predictions, strict=True):
        expected = np.array(golden[name], np.float64)
        off = np.abs(values - expected)
        if not (off <= GOLDEN_TOLERANCE).all():
            worst = int(np.argmax(np.where(np.isnan(off), np.inf, off)))
            raise UsageError(
                f"{path}: golden example {worst} gives {name} = {values[worst]:.6g}, "
                f"expected {expected[worst]:.6g} by its card"
            )
