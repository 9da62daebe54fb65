"""Reads plain definitions of ROS 2 types, line by line; rosbags' reader of all that one may hold takes longer."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from rosbags.interfaces import Nodetype

Definition = tuple[list[Any], list[Any]]  # (name, type, value) of each constant, (name, description) of each field


def read_definition(text: str) -> Definition:
    """The definition in lines `TYPE NAME` or, for integer constants, `TYPE NAME=VALUE`."""
    constants: list[Any] = []
    fields: list[Any] = []
    for line in text.splitlines():
        kind, name = line.split(" ")
        name, is_constant, value = name.partition("=")
        if is_constant:
            constants.append((name, kind, int(value)))
        else:
            fields.append((name, _description(kind)))
    return constants, fields


def _description(kind: str) -> Any:
    """Of one type, e.g. `float64`, `float64[36]` or `geometry_msgs/Point[]`."""
    element, is_many, count = kind.rstrip("]").partition("[")
    package, is_nested, name = element.partition("/")
    one: Any = (Nodetype.NAME, f"{package}/msg/{name}") if is_nested else (Nodetype.BASE, (element, 0))
    if not is_many:
        return one
    return (Nodetype.ARRAY, (one, int(count))) if count else (Nodetype.SEQUENCE, (one, 0))


def parts(definitions: Iterable[Definition]) -> Iterator[str]:
    """ROS names of the types that fields have."""
    for _, fields in definitions:
        for _, description in fields:
            is_many = description[0] in {Nodetype.ARRAY, Nodetype.SEQUENCE}
            node, detail = description[1][0] if is_many else description
            if node == Nodetype.NAME:
                yield detail
