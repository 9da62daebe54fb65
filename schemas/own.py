"""Converts messages of our own types (`tailor_msgs`) to ROS values and back, by reflection over the dataclass.

Fields keep name and order; `stamp_ns` becomes a header. Tuples of numbers become numpy arrays, because rosbags
serializes only those.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import is_dataclass
from functools import cache
from typing import Any

import numpy as np

from tailor.schemas.numbers import MAX_FROM_ROBOT, MAX_NUMBER, check_array, check_numbers, check_variances
from tailor.schemas.packages.msg_definitions import element_type, field_types
from tailor.schemas.ros_time import header, stamp_ns
from tailor.schemas.typesystem import ros_class, ros_type

Convert = Callable[[Any], Any]
ROBOT_FRAME = "base_link"  # REP-105


def _same(value: Any) -> Any:
    return value


def _number(most: float) -> Convert:
    def read(value: float) -> float:
        check_numbers(value, most=most)
        return value

    return read


def _variance(value: float) -> float:
    check_numbers(value)
    check_variances(value)
    return value


def _numbers(most: float) -> Convert:
    def read(values: Any) -> tuple[float, ...]:
        check_array(values, most)
        return tuple(values.tolist())

    return read


def _field(name: str, hint: Any, most: float) -> tuple[Convert, Convert]:
    """Writer and reader of one field, by its type hint; `most` limits floats but variances and covariances."""
    if hint is float:
        limit = MAX_NUMBER if name.startswith("cov_") else most
        return float, _variance if name.startswith("var_") else _number(limit)
    if hint in {int, bool, str}:
        return _same, _same
    element = element_type(hint)
    if element is float:
        return lambda values: np.array(values, dtype=np.float64), _numbers(most)
    if element is int:
        return lambda values: np.array(values, dtype=np.int64), lambda values: tuple(values.tolist())
    if element is bool:
        return lambda values: np.array(values, dtype=np.bool_), lambda values: tuple(values.tolist())
    if element is str:
        return list, tuple
    write, read = converters(element, most)
    # Of a generator, `tuple` makes ten places and cuts them; freed, they are kept for tuples of that length alone, 2000
    # of each length. Plans get shorter step by step: the launcher of an arm grew by 1 MB/h, until all are full.
    return lambda parts: [write(part) for part in parts], lambda parts: tuple([read(part) for part in parts])


@cache
def converters(kind: Any, most: float = MAX_NUMBER) -> tuple[Convert, Convert]:
    """Functions that convert a message of this own type to a ROS value and back; reading raises RefusedValueError.

    Args:
      kind: Type of the message, or of a part of one.
      most: Magnitude that the message around a part allows; in base_link none allows more than MAX_FROM_ROBOT.
    """
    hints = field_types(kind)
    stamped = next(iter(hints)) == "stamp_ns"
    frame = getattr(kind, "FRAME_ID", "")
    most = min(most, MAX_FROM_ROBOT) if frame == ROBOT_FRAME else most
    rows = [(name, *_field(name, hint, most)) for name, hint in hints.items() if name != "stamp_ns"]
    target = ros_class(ros_type(kind))

    def write(message: Any) -> Any:
        values = [convert(getattr(message, name)) for name, convert, _ in rows]
        return target(header(message.stamp_ns, frame), *values) if stamped else target(*values)

    def read(ros: Any) -> Any:
        values = [convert(getattr(ros, name)) for name, _, convert in rows]
        return kind(stamp_ns(ros.header), *values) if stamped else kind(*values)

    return write, read


def example(kind: Any) -> Any:
    """A legal message of any type: zeros, empty strings, and one element in every sequence of nested types."""
    return kind(*(_example_field(hint) for hint in field_types(kind).values()))


def _example_field(hint: Any) -> Any:
    if hint in {int, float, bool, str}:
        return hint()
    element = element_type(hint)
    return (example(element),) if is_dataclass(element) else ()
