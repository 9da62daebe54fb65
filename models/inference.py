"""ONNX action models that predict. The only module that imports onnxruntime."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import onnxruntime
from numpy.typing import NDArray

from tailor.models.bounds.interval_boxes import UPPER_SCORE
from tailor.models.bounds.model_bounds import ModelBounds
from tailor.models.cards.card import Card

Array = NDArray[np.float64]

ROUNDING = 1e-6  # of a sum of single-precision probabilities


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
        mean, *rest = _outputs(self.session, arguments, len(self.card["outputs"]))
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
        mean, *rest = _outputs(self.session, arguments, len(self.card["outputs"]))
        half = float(self.card["test"].get("interval90_factor", UPPER_SCORE)) * rest[0]
        lower, upper = rest if self.calibrated else (mean - half, mean + half)
        mean, lower, upper = self._valid(mean, (mean, lower, upper), upper - mean)
        return mean, lower, upper

    @property
    def calibrated(self) -> bool:
        """Whether the graph has intervals of its own, and not only a standard deviation."""
        return len(self.card["outputs"]) == 3

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
        rows = np.ascontiguousarray(arguments, np.float64)
        (probability,) = _outputs(self.session, rows, 1)
        # the sum of an ensemble's shares may round to just above one
        within = np.minimum(np.maximum(probability, 0), 1)
        # a tree assigns NaN to some leaf, so the inputs are checked, too
        valid = (np.abs(probability - within) <= ROUNDING) & np.isfinite(rows.sum(axis=1))
        return np.where(valid, within, np.nan)


OnnxModel = OnnxDuration | OnnxSuccess


def run(session: Any, arguments: Array, count: int) -> list[Array] | str:
    """All outputs of a model, each of shape (n,), or what is wrong with them.

    Args:
      session: Inference session of onnxruntime.
      arguments: Arguments of the action, shape (n, k).
      count: Number of outputs that its card has.
    """
    rows = np.ascontiguousarray(arguments, np.float64)
    try:
        outputs = session.run(None, {"arguments": rows})
    except Exception as error:  # onnxruntime's exceptions have no common base
        return f"onnxruntime cannot run it ({str(error).partition(chr(10))[0]})"
    if len(outputs) != count or not all(_is_column(each, len(rows)) for each in outputs):
        shapes = ", ".join(map(_shape, outputs)) or "none"
        return f"returns shapes {shapes} for {len(rows)} rows, expected {count} columns of numbers"
    return [each.astype(np.float64) for each in outputs]


def _shape(values: Any) -> str:
    return str(list(values.shape)) if isinstance(values, np.ndarray) else f"({type(values).__name__})"


def _is_column(values: Any, rows: int) -> bool:
    return isinstance(values, np.ndarray) and values.shape == (rows,) and values.dtype.kind == "f"


def _outputs(session: Any, arguments: Array, count: int) -> list[Array]:
    """All outputs of a model; NaN where it has none: a tick goes on without this prediction."""
    outputs = run(session, arguments, count)
    return [np.full(len(arguments), np.nan)] * count if isinstance(outputs, str) else outputs


def open_session(content: bytes) -> Any:
    """Inference session of an ONNX model that starts no threads; exceptions of onnxruntime are not caught."""
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    options.execution_mode = onnxruntime.ExecutionMode.ORT_SEQUENTIAL
    options.enable_mem_reuse = False  # saves 2 us per call: results do not wait for each other's memory
    options.add_session_config_entry("session.intra_op.allow_spinning", "0")
    options.log_severity_level = 4  # errors are raised as exceptions, not printed beside them
    # without fallback, by which onnxruntime would print the error and try the same provider again
    return onnxruntime.InferenceSession(content, options, providers=["CPUExecutionProvider"], enable_fallback=0)
