"""What is wrong with a message type of a package: it is refused before the codec of every process meets it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from types import NoneType
from typing import Any, get_args

from tailor.schemas.packages.msg_definitions import declarations, field_types, with_parts
from tailor.schemas.packages.ros_names import ros_type

STAMP = "stamp_ns"  # stands for the header
ROS_FIELD = re.compile(r"[a-zA-Z][a-zA-Z0-9_]*")
ROS_NAME = re.compile(r"[a-zA-Z][a-zA-Z0-9_]*/msg/[a-zA-Z][a-zA-Z0-9_]*")
WIDTH = re.compile(r"^u?(int|float)\d+$")


def faults_of_fields(kind: Any, known: Mapping[str, type]) -> Iterator[str]:
    """Faults of a message type that the codec could not carry, or that would change types of others.

    Args:
      kind: A dataclass derived from Message.
      known: Types of the other topics by ROS name.
    """
    try:
        parts = with_parts([kind])
    except (TypeError, NameError, AttributeError, RecursionError) as error:  # of type hints
        yield f"type {kind.__name__}: {error}"
        return
    others = {ros_type(each): each for each in with_parts(known.values())} if len(parts) > 1 else {}
    for part in parts:
        yield from (f"type {part.__name__}: {fault}" for fault in _faults_of(part))
        if others.get(ros_type(part), part) is not part:
            yield f"type {part.__name__} has the name {ros_type(part)} of another message"


def _faults_of(kind: Any) -> Iterator[str]:
    """Faults of one dataclass."""
    hints, name = field_types(kind), ros_type(kind)
    if not ROS_NAME.fullmatch(name):
        yield f"its ROS name is '{name}', expected letters, digits and _ around /msg/"
        return
    if not hints:
        yield "expected at least one field"
    yield from (f"field '{each}', expected a name of ROS 2" for each in hints if not ROS_FIELD.fullmatch(each))
    if STAMP in hints and (next(iter(hints)) != STAMP or hints[STAMP] is not int or "header" in hints):
        yield f"expected {STAMP}: int as the first field, and no field 'header' beside it"
    yield from (f"field '{each}' may be None" for each, hint in hints.items() if NoneType in get_args(hint))
    try:
        lines = declarations(kind).values()
    except TypeError as error:
        yield str(error)
        return
    if getattr(kind, "ROS_TYPE", "") and not kind.__module__.startswith("tailor."):
        yield from _faults_of_standard(name, "\n".join(lines))


def _faults_of_standard(name: str, lines: str) -> Iterator[str]:
    """Fault of a type of ROS 2 whose fields are not those that the dataclass has."""
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore  # 0.1 s that no other package waits for

    fields = get_typestore(Stores.ROS2_JAZZY).fielddefs
    if name not in fields:
        yield f"ROS_TYPE is '{name}', expected one of ROS 2's common interfaces"
    elif _without_widths(get_types_from_msg(lines, name)[name][1]) != _without_widths(fields[name][1]):
        yield f"its fields are not those of {name}: {', '.join(each for each, _ in fields[name][1])}"


def _without_widths(fields: Any) -> list[Any]:
    """Fields whose single numbers are of any width."""
    return [(each, node, _without_width(detail)) for each, (node, detail) in fields]


def _without_width(detail: Any) -> Any:
    is_single = isinstance(detail, tuple) and isinstance(detail[0], str)
    return WIDTH.sub(r"\1", detail[0]) if is_single else detail
