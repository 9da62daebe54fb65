"""Message types from the `.msg` files of a ROS 2 interface package, for robots whose messages exist already."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import make_dataclass
from functools import cache
from importlib.resources.abc import Traversable
from keyword import iskeyword
from typing import Any

from tailor.schemas.messages import Message

HEADER = "std_msgs/Header"
STAMP = "stamp_ns"  # stands for the header
FIELD_NAME = re.compile(r"[a-z](_?[a-z0-9])*")  # as ROS 2 has it
PRIMITIVES: Mapping[str, type] = {"int64": int, "float64": float, "bool": bool, "string": str}


@cache
def read_messages(folder: Traversable, frame: str = "") -> dict[str, Any]:
    """Frozen dataclasses of a package's messages, to be used like those that are written by hand.

    Args:
      folder: A ROS 2 interface package: its name is the ROS package's, and `msg/` in it holds the files.
      frame: Frame in the headers.

    Returns:
      Types by name, e.g. `read_messages(resources.files("my_robot") / "my_robot_msgs")["Gripper"]`. Fields are the
      file's; a header, which must come first, becomes `stamp_ns`. Another call returns the same types.

    Raises:
      ValueError: There is no file, or one cannot be read: a field that is neither int64, float64, bool, string nor an
        array of one of them or of a message of the same package. The message names file and line.
    """
    files = {each.name.removesuffix(".msg"): each for each in _msg_files(folder)}
    types: dict[str, Any] = {}
    for name in files:
        _read(name, files, types, {"__module__": __name__, "ROS_PACKAGE": folder.name, "FRAME_ID": frame})
    return types


def _msg_files(folder: Traversable) -> list[Traversable]:
    inside = folder / "msg"
    found = [each for each in inside.iterdir() if each.name.endswith(".msg")] if inside.is_dir() else []
    if not found:
        raise ValueError(f"{inside}: no .msg file")
    return sorted(found, key=lambda each: each.name)


def _read(name: str, files: Mapping[str, Traversable], types: dict[str, Any], namespace: dict[str, Any]) -> Any:
    """The type of a file, and before it those of its parts."""
    if name not in types:
        types[name] = None  # marks a type that contains itself
        fields: list[tuple[str, Any]] = []
        for number, line in enumerate(files[name].read_text(encoding="utf-8").splitlines(), 1):
            written = line.partition("#")[0].split()
            if not written:
                continue
            kind = _field(written, first=not fields, files=files, types=types, namespace=namespace)
            field = STAMP if written[0] == HEADER else written[-1]
            if kind is None or field in dict(fields):
                known = ", ".join((*PRIMITIVES, *files))
                raise ValueError(
                    f"{files[name]}, line {number}: '{line.strip()}', expected a new NAME after one of: {known}"
                )
            fields.append((field, kind))
        types[name] = make_dataclass(name, fields, bases=(Message,), namespace=dict(namespace), frozen=True, slots=True)
    return types[name]


def _field(
    written: list[str], first: bool, files: Mapping[str, Traversable], types: dict[str, Any], namespace: dict[str, Any]
) -> Any:
    """Type of a field; None if there is none such."""
    if len(written) != 2 or not FIELD_NAME.fullmatch(written[1]) or iskeyword(written[1]) or written[1] == STAMP:
        return None
    name, array, rest = written[0].partition("[]")
    if name == HEADER:
        return int if first and not array else None
    element = PRIMITIVES.get(name)
    if element is None and array and name in files:
        element = _read(name, files, types, namespace)
    if element is None or rest:
        return None
    return tuple[element, ...] if array else element  # type: ignore[valid-type]
