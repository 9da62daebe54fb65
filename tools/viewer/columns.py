"""Packs the samples of a run into columns, so that an hour's page is small and opens fast.

A column is a list of whole numbers: the first value, then differences, in the last digit that the page shows. Samples
that repeat their neighbours on both sides are left out: the page shows a sample until the next one.
"""

from __future__ import annotations

import json
import math
from array import array
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import count
from typing import Any

import numpy as np

from tailor.tools.viewer.event_fields import DIGITS
from tailor.tools.viewer.timeline import Event, is_sample

COUNTED = "tick"  # the page counts these
TIME_DIGITS = 3
MAX_STEPS = 2.0**53  # beyond, a float holds no whole number exactly


@dataclass(slots=True)
class _Stretch:
    """Samples of one kind and form, as numbers: a table for each would take many times as much memory."""

    form: Any
    at_s: array[float] = field(default_factory=lambda: array("d"))
    values: array[float] = field(default_factory=lambda: array("d"))  # sample after sample; NaN for none


class Packing:
    """Events as the page reads them, in JSON: rows as they come, then blocks of the samples among them."""

    def __init__(self) -> None:
        self._samples: dict[str, list[_Stretch]] = {}  # by kind

    def rows(self, events: Iterable[Event]) -> Iterator[str]:
        """Rows [at, kind, fields] of the events that are no samples; the samples are kept for `blocks`."""
        for event in events:
            if is_sample(event.kind):
                _add(self._samples.setdefault(event.kind, []), event)
            else:
                yield compact_json(event.json_value())

    def blocks(self) -> Iterator[str]:
        """Blocks of samples of one kind and form, of all events so far.

        A block's `like` has the form of the fields, with the number of a column in place of each value.
        """
        for kind, stretches in self._samples.items():
            yield from (compact_json(_block(kind, each)) for each in stretches)


def compact_json(value: Any) -> str:
    """JSON without spaces; raises ValueError for numbers that are none there."""
    return json.dumps(value, allow_nan=False, separators=(",", ":"))


def _add(stretches: list[_Stretch], event: Event) -> None:
    """Add a sample to the last stretch, or begin one if its form is another."""
    form, numbers = _flattened(event.fields)
    if not stretches or stretches[-1].form != form:
        stretches.append(_Stretch(form))
    stretches[-1].at_s.append(event.at_s)
    stretches[-1].values.extend(math.nan if number is None else number for number in numbers)


def _block(kind: str, stretch: _Stretch) -> dict[str, Any]:
    at = np.array(stretch.at_s)
    values = np.array(stretch.values).reshape(len(at), len(stretch.values) // len(at))
    kept = slice(None) if kind == COUNTED else _distinguished(values)
    return {
        "kind": kind,
        "length": len(at[kept]),
        "at": _column(at[kept], TIME_DIGITS),
        "like": _numbered(stretch.form, count()),
        "columns": [_column(column, DIGITS) for column in values[kept].T],
    }


def _distinguished(values: Any) -> Any:
    """Which samples differ from the one before or the one after."""
    differs = np.ones(len(values) + 1, dtype=bool)
    differs[1:-1] = ((values[1:] != values[:-1]) & ~(np.isnan(values[1:]) & np.isnan(values[:-1]))).any(axis=1)
    return differs[1:] | differs[:-1]


def _column(values: Any, digits: int) -> list[int] | dict[str, list[float | None]]:
    """Differences as whole numbers, without the last ones that are 0; {"plain": values} where that is impossible."""
    steps = np.rint(values * 10**digits)
    if not (np.abs(steps) < MAX_STEPS).all():  # as well where one is missing
        return {"plain": [None if np.isnan(value) else value for value in values.tolist()]}
    differences = np.diff(steps, prepend=0.0).astype(np.int64)
    whole: list[int] = np.trim_zeros(differences, "b").tolist()
    return whole


def _flattened(value: Any) -> tuple[Any, list[float | None]]:
    """The form of a JSON value of tables, lists and numbers, hashable, and its numbers."""
    numbers: list[float | None] = []
    return _walked(value, numbers), numbers


def _walked(value: Any, numbers: list[float | None]) -> Any:
    """The form; the numbers are appended."""
    if isinstance(value, dict):
        return ("table", *[(name, _walked(each, numbers)) for name, each in value.items()])
    if isinstance(value, list):
        return ("list", *[_walked(each, numbers) for each in value])
    numbers.append(value)
    return "number"


def _numbered(form: Any, numbers: Iterator[int]) -> Any:
    """The form as JSON, with the next numbers for its columns."""
    if form == "number":
        return next(numbers)
    kind, *parts = form
    if kind == "table":
        return {name: _numbered(part, numbers) for name, part in parts}
    return [_numbered(part, numbers) for part in parts]
