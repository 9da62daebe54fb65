"""A domain with pinned quantities, by which an evaluation forces choices of the executive."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tailor.executive.interfaces.domain import Domain, LabelQuery
from tailor.executive.interfaces.values import Interval

Pins = Mapping[tuple[str, str], float]  # (label, quantity) -> value


class PinnedDomain:
    """Wraps a domain: a pinned quantity has its value wherever the predicates leave it free."""

    def __init__(self, inner: Domain, pins: Pins) -> None:
        self._inner = inner
        self._pins = pins

    def __getattr__(self, name: str) -> Any:
        return getattr(self._inner, name)

    def value(self, query: LabelQuery) -> Interval | None:
        """The inner domain's interval, or the pin if that is no single value."""
        value = self._inner.value(query)
        pin = self._pins.get((query.label, query.quantity))
        if pin is None or (value is not None and value.lower == value.upper):
            return value
        return Interval(pin, pin)
