"""ROS 2 message definitions, derived from the dataclasses of our own types."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any, get_args, get_type_hints

from tailor.schemas.packages.ros_names import ros_type

HEADER = "std_msgs/Header header"
PRIMITIVES: dict[Any, str] = {int: "int64", float: "float64", bool: "bool", str: "string"}


@cache  # to read the hints of a type takes 1 ms, and each start asks ten times for those of each type
def field_types(kind: type) -> Mapping[str, Any]:
    """The type of every field of a message dataclass, in order."""
    hints = get_type_hints(kind)
    return {field.name: hints[field.name] for field in fields(kind)}


def element_type(hint: Any) -> Any:
    """The element type of a sequence field, e.g. `float` of `tuple[float, ...]`; None for a plain field."""
    return get_args(hint)[0] if get_args(hint) else None


def with_parts(kinds: Iterable[type]) -> tuple[type, ...]:
    """The given types and the types nested in their sequences, parts before wholes, each once."""
    ordered: dict[type, None] = {}
    for kind in kinds:
        elements = map(element_type, field_types(kind).values())
        nested = with_parts(element for element in elements if isinstance(element, type) and is_dataclass(element))
        ordered.update(dict.fromkeys(nested))
        ordered[kind] = None
    return tuple(ordered)


def declarations(kind: type) -> dict[str, str]:
    """One line of ROS 2 message definition for each field; `stamp_ns` becomes a header.

    Raises:
      TypeError: A field has a type that no ROS 2 type stands for.
    """
    return {name: HEADER if name == "stamp_ns" else _declaration(name, h) for name, h in field_types(kind).items()}


def _declaration(name: str, hint: Any) -> str:
    element: Any = element_type(hint)
    if hint in PRIMITIVES:
        return f"{PRIMITIVES[hint]} {name}"
    if element in PRIMITIVES:
        return f"{PRIMITIVES[element]}[] {name}"
    if isinstance(element, type) and is_dataclass(element):
        return f"{ros_type(element).replace('/msg/', '/')}[] {name}"
    raise TypeError(f"field '{name}' is {hint}, expected int, float, bool, str, or a tuple of them or of dataclasses")
