"""A domain in which some quantities of some labels are given: how an evaluation forces a choice upon the executive."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tailor.executive.interfaces.domain import Domain, LabelQuery
from tailor.executive.interfaces.values import Interval

Pins = Mapping[tuple[str, str], float]  # (label, quantity) -> value


class PinnedDomain:
    """Another domain, but a pinned quantity has its pinned value wherever the predicates leave it free."""

    def __init__(self, inner: Domain, pins: Pins) -> None:
        self._inner = inner
        self._pins = pins

    def __getattr__(self, name: str) -> Any:
        return getattr(self._inner, name)

    def value(self, query: LabelQuery) -> Interval | None:
        """The inner domain's answer, or the pin where that is no single value."""
        said = self._inner.value(query)
        pin = self._pins.get((query.label, query.quantity))
        if pin is None or (said is not None and said.lower == said.upper):
            return said
        return Interval(pin, pin)
