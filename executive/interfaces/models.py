"""Interfaces of action models, independent of how a model was learned. All methods are pure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from tailor.executive.interfaces.values import Array, Columns


class DurationModel(Protocol):
    """Predicts the duration of an action."""

    def predict(self, arguments: Array) -> tuple[Array, Array]:
        """Predict durations.

        Args:
          arguments: Values of Action.arguments, shape (n, k).

        Returns:
          Mean and standard deviation in seconds, shape (n,) each; NaN for arguments outside the model's domain.
        """
        ...


class SuccessModel(Protocol):
    """Predicts whether an action succeeds."""

    def probability(self, arguments: Array) -> Array:
        """Predict probabilities of success.

        Args:
          arguments: Values of Action.arguments, shape (n, k).

        Returns:
          Probabilities from 0 to 1, shape (n,); NaN for arguments outside the model's domain.
        """
        ...


class ModelBounds(Protocol):
    """Bounds of a model's prediction on boxes of arguments.

    A model that has bounds offers them as attribute `bounds`. Without them no certificate is possible.
    """

    def lower_bound(self, lower: Columns, upper: Columns, k_std: float = 0.0) -> Array:
        """Lower bound of the mean plus `k_std` standard deviations.

        Args:
          lower: Lower ends of the boxes, one array per argument; they broadcast to one shape.
          upper: Upper ends, in the same form.
          k_std: Weight of the standard deviation, >= 0.

        Returns:
          One bound per box, in seconds for durations.
        """
        ...

    def upper_bound(self, lower: Columns, upper: Columns) -> Array:
        """Upper bound of the mean; arguments as in `lower_bound`."""
        ...

    @property
    def is_linear(self) -> bool:
        """Whether there is a `linear_bound`."""
        ...

    def linear_bound(
        self, lower: Columns, upper: Columns, radius: Columns, k_std: float = 0.0
    ) -> tuple[Array, dict[int, Array]]:
        """Lower bound of the mean plus `k_std` standard deviations, averaged over displaced copies of boxes.

        Args:
          lower: Lower ends of the copies, one array per argument; they broadcast to (copies, n, m).
          upper: Upper ends, in the same form.
          radius: Half of each argument's range before it was displaced.
          k_std: Weight of the standard deviation, >= 0.

        Returns:
          The bound in the middle of the boxes, and its slope by index of the argument, each (n, m).
        """
        ...

    def within(self, lower: Columns, upper: Columns) -> ModelBounds:
        """Bounds that are valid only for arguments in this box, and faster to compute."""
        ...

    @property
    def effort(self) -> int:
        """Approximate number of elementary comparisons for one bound."""
        ...


@dataclass(frozen=True, slots=True)
class Models:
    """The loaded action models of one robot.

    Attributes:
      durations: Duration models by zoo path, e.g. "goToPose/duration".
      successes: Success models by zoo path.
    """

    durations: Mapping[str, DurationModel]
    successes: Mapping[str, SuccessModel]

    def duration_path(self, path: str, in_context: bool) -> str:
        """Path of the duration model for an action that names `path`.

        Args:
          path: `Action.duration_model`.
          in_context: Whether the action has objects beside it now. Then it is the model that was calibrated beside
            objects, if there is one: "goToPose/duration_beside" for "goToPose/duration".
        """
        beside = f"{path}_beside"
        return beside if in_context and beside in self.durations else path
