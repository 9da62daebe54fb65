"""Success of an action beside objects: independent of each other, so the probabilities multiply."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.models import ModelBounds, SuccessModel
from tailor.executive.interfaces.results import name_of, wrong_result
from tailor.executive.interfaces.values import Array, Columns


@dataclass(frozen=True, slots=True)
class ContextSuccess:
    """Success model of one action in the context of m objects.

    Attributes:
      own: Success of the action by itself; None: it never fails by itself.
      beside: Success of the action in spite of one object; its arguments end with the object's row.
      rows: The objects, shape (m, c), m >= 1; constants.
      may_meet: See ActionContext.
    """

    own: SuccessModel | None
    beside: SuccessModel
    rows: Array
    may_meet: Callable[[Array, Array], Array] | None = None

    def probability(self, arguments: Array) -> Array:
        """Probability of success, shape (n,), for arguments of shape (n, k); one model call for all objects."""
        own, in_spite = self.factors(arguments)
        return own * in_spite

    def factors(self, arguments: Array) -> tuple[Array, Array]:
        """Probability of success by itself, and in spite of the objects, each of shape (n,)."""
        count, objects = len(arguments), len(self.rows)
        near = np.ones((objects, count), bool) if self.may_meet is None else self.may_meet(arguments, self.rows)
        if self.may_meet is not None and np.shape(near) != (objects, count):
            called = f"{name_of(self.may_meet)}, may_meet of an action's context,"
            raise wrong_result(called, near, f"an array of shape ({objects}, {count}): rows of objects, arguments")
        which, each = np.nonzero(near)
        beside = np.ones((objects, count))
        if len(each):
            beside[which, each] = self.beside.probability(np.hstack([arguments[each], self.rows[which]]))
        product: Array = np.ones(count)
        for probability in beside:  # in this order, on every machine
            product = product * probability
        return np.ones(count) if self.own is None else self.own.probability(arguments), product

    @property
    def bounds(self) -> ContextBounds | None:
        """Upper bounds of the probability, which alone a proof needs; None if that of the action by itself has none.

        Objects without bounds count as never met, and so do all where some are left out: what the model says of one
        does not hold where it is not asked. So the upper bound is still one.
        """
        own, beside = getattr(self.own, "bounds", None), getattr(self.beside, "bounds", None)
        if self.own is not None and own is None:
            return None
        if beside is None or self.may_meet is not None:
            return ContextBounds(own, (), self.rows[:0])
        return ContextBounds(own, (beside,) * len(self.rows), self.rows)


@dataclass(frozen=True, slots=True)
class ContextBounds:
    """Upper bounds of a `ContextSuccess`: those of the factors, for objects that stay where they are."""

    own: ModelBounds | None
    beside: tuple[ModelBounds, ...]  # (m,)
    rows: Array  # (m, c)

    def upper_bound(self, lower: Columns, upper: Columns) -> Array:
        """Upper bound of the probability."""
        own, in_spite = self.upper_bounds(lower, upper)
        return own * in_spite

    def upper_bounds(self, lower: Columns, upper: Columns) -> tuple[Array, Array]:
        """Upper bounds of success by itself, and in spite of the objects."""
        bounds = [np.clip(bound.upper_bound(*box), 0.0, 1.0) for bound, box in self._factors(lower, upper)]
        own = product = np.ones(1)
        if self.own is not None:
            own = bounds.pop(0)
        for bound in bounds:  # in the order of the probabilities: rounding keeps the order of products
            product = product * bound
        return own, product

    def within(self, lower: Columns, upper: Columns) -> ContextBounds:
        """Bounds that are valid only for arguments in this box, each object's with the leaves near it."""
        restricted = [bound.within(*box) for bound, box in self._factors(lower, upper)]
        own = None if self.own is None else restricted.pop(0)
        return ContextBounds(own, tuple(restricted), self.rows)

    @property
    def effort(self) -> int:
        """Approximate number of elementary comparisons for one bound."""
        own = 0 if self.own is None else self.own.effort
        return own + sum(bound.effort for bound in self.beside)

    def _factors(self, lower: Columns, upper: Columns) -> list[tuple[ModelBounds, tuple[Columns, Columns]]]:
        """Each factor's bounds with its box of arguments."""
        factors = [] if self.own is None else [(self.own, (lower, upper))]
        for bound, row in zip(self.beside, self.rows, strict=True):
            constant = tuple(np.full((1, 1, 1), value) for value in row)
            factors.append((bound, ((*lower, *constant), (*upper, *constant))))
        return factors
