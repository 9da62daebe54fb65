"""Reads nodes and constants from an ONNX file: a minimal parser of protocol buffers for the fields that hold trees.

The executive depends on onnxruntime only, which computes a graph but does not expose its content.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

VARINT, FIXED64, BYTES, FIXED32 = 0, 1, 2, 5  # wire types of protocol buffers
FLOATS_TAG, INTS_TAG = 7 << 3 | FIXED32, 8 << 3 | VARINT  # AttributeProto.floats and .ints, one tag an element
DTYPES = {1: "<f4", 4: "<u2", 6: "<i4", 7: "<i8", 11: "<f8"}  # TensorProto.data_type


@dataclass(frozen=True, slots=True)
class Node:
    """An operator: its name, names of inputs and outputs, and those attributes that are lists of numbers."""

    op: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    attributes: dict[str, NDArray[Any]]
    name: str = ""


@dataclass(frozen=True, slots=True)
class Contents:
    """The nodes and constants of a graph."""

    nodes: tuple[Node, ...]
    constants: dict[str, NDArray[Any]]


def read_graph(model: bytes) -> Contents:
    """Read the graph of an ONNX model.

    Raises:
      ValueError: The file is truncated, or not of the expected form.
    """
    try:
        graph = dict(_fields(memoryview(model)))[7]
        fields = list(_fields(graph))
        nodes = tuple(_node(value) for number, value in fields if number == 1)
        return Contents(nodes, dict(_tensor(value) for number, value in fields if number == 5))
    except (IndexError, KeyError, TypeError) as error:
        raise ValueError(f"no readable ONNX graph: {error!r}") from None


def _fields(message: memoryview) -> Iterator[tuple[int, Any]]:
    """Number and value of each field, in order."""
    at = 0
    while at < len(message):
        tag, at = _varint(message, at)
        kind = tag & 7
        if kind == VARINT:
            value, at = _varint(message, at)
            yield tag >> 3, value
            continue
        size = {FIXED64: 8, FIXED32: 4}.get(kind)
        if size is None:
            size, at = _varint(message, at)
        yield tag >> 3, message[at : at + size]
        at += size


def _varint(message: memoryview, at: int) -> tuple[int, int]:
    """A number of seven bits per byte, least significant first, and the position after it."""
    value = shift = 0
    while True:
        byte = message[at]
        value |= (byte & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if byte < 0x80:
            return value, at


def _node(message: memoryview) -> Node:
    texts: dict[int, list[str]] = {1: [], 2: [], 3: [""], 4: []}
    attributes: dict[str, NDArray[Any]] = {}
    for number, value in _fields(message):
        if number in texts:
            texts[number].append(bytes(value).decode())
        elif number == 5:
            name, numbers = _attribute(value)
            attributes[name] = numbers
    return Node(texts[4][0], tuple(texts[1]), tuple(texts[2]), attributes, texts[3][-1])


def _attribute(message: memoryview) -> tuple[str, NDArray[Any]]:
    """Name and numbers; no numbers for attributes of other kinds. Long lists are read as arrays."""
    at = 2 + message[1]  # names are short: their length is one byte
    name, rest = bytes(message[2:at]).decode(), np.frombuffer(message[at:], np.uint8)
    if not len(rest) or rest[0] not in (FLOATS_TAG, INTS_TAG):
        return name, np.empty(0)
    return name, _floats(rest) if rest[0] == FLOATS_TAG else _ints(rest)


def _floats(rest: NDArray[np.uint8]) -> NDArray[np.float32]:
    """Floats, each with a tag and four bytes; the attribute's type follows them."""
    groups = rest[: len(rest) // 5 * 5].reshape(-1, 5)
    count = int(np.argmin(np.append(groups[:, 0] == FLOATS_TAG, False)))
    return np.ascontiguousarray(groups[:count, 1:]).view("<f4").ravel()


def _ints(rest: NDArray[np.uint8]) -> NDArray[np.int64]:
    """Integers, each with a tag and a varint; the attribute's type follows them."""
    ends = np.flatnonzero(rest < 0x80)
    starts = np.append(0, ends[:-1] + 1)
    places = np.arange(len(rest)) - np.repeat(starts, ends - starts + 1)
    parts = (rest & 0x7F).astype(np.int64) << (7 * places)
    numbers = np.add.reduceat(parts, starts)
    tags, values = numbers[0::2], numbers[1::2]
    count = int(np.argmin(np.append(tags == INTS_TAG, False)))
    return values[:count]


def _tensor(message: memoryview) -> tuple[str, NDArray[Any]]:
    fields = list(_fields(message))
    single = dict(fields)
    shape = [value for number, value in fields if number == 1]
    numbers = np.frombuffer(single[9], DTYPES[single[2]]) if 9 in single and single[2] in DTYPES else np.empty(0)
    return bytes(single[8]).decode(), numbers.reshape(shape) if len(numbers) else numbers
