"""Values that domains, models and the executive share: arrays, facts, intervals."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array: TypeAlias = NDArray[np.float64]
else:
    Array = Any  # the planner needs facts alone: it starts without numpy
Columns = tuple[Array, ...]  # one array per parameter or argument; they broadcast to one shape
Spans = Callable[[Columns, Columns], tuple[Columns, Columns]]  # lower and upper ends to lower and upper ends
Fact = tuple[str, ...]  # a ground atom: ("robot", "pos1")
Belief = Any  # a domain's own frozen value


@dataclass(frozen=True, slots=True)
class Interval:
    """A closed range of values, lower <= upper; a range of one point binds a variable."""

    lower: float
    upper: float
