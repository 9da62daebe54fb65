"""Context of an action: objects of the belief near which it may fail, one row of numbers for each (paper 7).

E.g. an opponent's place and radius. A model that was learned with one object serves any number of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tailor.executive.interfaces.results import name_of, wrong_result
from tailor.executive.interfaces.values import Array, Belief

ContextRows = tuple[tuple[float, ...], ...]  # one row per object, one value per column


@dataclass(frozen=True, slots=True)
class ContextColumn:
    """One number of a row.

    Attributes:
      name: Unique among the columns and the action's parameters, e.g. "obstacle_x".
      unit: "m", "rad", "m/s".
      lower: Lower end of the range from which training draws.
      upper: Upper end of that range.
      tolerance: Change of the believed value, in `unit`, beyond which a running action is deliberated anew; None: any
        change is accepted.
    """

    name: str
    unit: str
    lower: float
    upper: float
    tolerance: float | None = None


@dataclass(frozen=True, slots=True)
class ActionContext:
    """Objects near which an action may fail, independently of each other.

    Attributes:
      columns: Columns of `rows`, c of them.
      rows: Maps the belief to the objects of now, shape (m, c); deterministic. The order of the rows has no effect.
        More than about ten objects slow deliberation down: keep to those that matter.
      success_model: Path in the robot's model zoo, e.g. "goToPose/clearance": the probability that the action succeeds
        in spite of one object. Its arguments are Action.arguments followed by one row.
      failure: Failure that the object causes, as the task sampler returns it, e.g. "obstacle". Only this failure is
        learned by `success_model`; all others belong to Action.success_model.
      failure_cost_s: Seconds that meeting an object costs, if that is more than refinement's `risk_cost_s`.
      may_meet: Whether an action may meet each object at all, shape (m, n), for arguments of shape (n, k) and rows of
        shape (m, c); where it may not, success in spite of it is certain and `success_model` is not called. Saves time
        among many objects. None: anywhere.
    """

    columns: tuple[ContextColumn, ...]
    rows: Callable[[Belief], Array]
    success_model: str
    failure: str
    failure_cost_s: float = 0.0
    may_meet: Callable[[Array, Array], Array] | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the columns."""
        return tuple(column.name for column in self.columns)

    def believed(self, belief: Belief) -> ContextRows:
        """The rows of now in an order that depends on their values alone.

        Raises:
          UsageError: `rows` does not return an array of shape (m, c).
        """
        returned: Any = self.rows(belief)
        try:
            rows = np.asarray(returned, dtype=np.float64)
        except (TypeError, ValueError):  # no numbers, or rows of different lengths
            rows = np.zeros(0)
        if rows.ndim != 2 or rows.shape[1] != len(self.columns):
            expected = f"an array of shape (m, {len(self.columns)}): {', '.join(self.names)} of each object"
            raise wrong_result(f"{name_of(self.rows)}, rows of an action's context,", returned, expected)
        return tuple(sorted(map(tuple, rows.tolist())))
