"""Packs the samples of a run into columns, so that an hour's page is small and opens fast.

A column is a list of whole numbers: the first value, then differences, in the last digit that the page shows. Samples
that repeat their neighbours on both sides are left out: the page shows a sample until the next one.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import count, groupby
from typing import Any

import numpy as np

from tailor.tools.viewer.event_fields import DIGITS
from tailor.tools.viewer.timeline import Event, is_sample

COUNTED = "tick"  # the page counts these
TIME_DIGITS = 3
MAX_STEPS = 2.0**53  # beyond, a float holds no whole number exactly

Block = dict[str, Any]


def packed(events: Iterable[Event]) -> tuple[list[list[Any]], list[Block]]:
    """All events as the page reads them.

    Returns:
      Rows [at, kind, fields] of what is no sample, and blocks of samples of one kind and form.
      A block's `like` has the form of the fields, with the number of a column in place of each value.
    """
    rows: list[list[Any]] = []
    samples: dict[str, list[Event]] = {}
    for event in events:
        if is_sample(event.kind):
            samples.setdefault(event.kind, []).append(event)
        else:
            rows.append(event.json_value())
    return rows, [block for kind, each in samples.items() for block in _blocks(kind, each)]


def _blocks(kind: str, events: list[Event]) -> Iterator[Block]:
    """A block for each stretch of samples with the same form."""
    flat = ((event.at_s, *_flattened(event.fields)) for event in events)
    for like, stretch in groupby(flat, key=lambda sample: sample[1]):
        samples = list(stretch)
        at = np.array([at_s for at_s, _, _ in samples])
        values = np.array([each for _, _, each in samples], dtype=np.float64)  # NaN where there is none
        kept = slice(None) if kind == COUNTED else _told_apart(values)
        columns = [_column(column, DIGITS) for column in values[kept].T]
        at = at[kept]
        yield {
            "kind": kind,
            "length": len(at),
            "at": _column(at, TIME_DIGITS),
            "like": _numbered(like, count()),
            "columns": columns,
        }


def _told_apart(values: Any) -> Any:
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
