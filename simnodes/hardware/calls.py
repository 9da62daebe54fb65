"""Calls into hardware, in several threads: what they raise, and how long they take."""

from __future__ import annotations

import dataclasses
import struct
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from tailor.runtime.clock import Clock

_CODES = {"float": "d", "int": "q"}  # of struct, by the type of a field
MAX_TEXT = 160  # characters of a fault


def fault_text(text: str) -> str:
    """A fault in one line that a driver's state can carry: whatever a device says, it is short, and text on the bus."""
    return " ".join(text.split())[:MAX_TEXT].encode(errors="backslashreplace").decode()


def unfit_text(message: Any) -> str:
    """The fields of a message that hold no number where one belongs; empty: none."""
    unfit = (each for each in _numbers(message) if not _fits(each[2], each[1]))
    return "; ".join(f"{name} is {type(value).__name__}, expected {kind}" for name, kind, value in unfit)


def _numbers(message: Any) -> Iterator[tuple[str, str, object]]:
    """Name, type and value of the fields that hold one number."""
    for field in dataclasses.fields(message):
        kind = getattr(field.type, "__name__", field.type)
        if kind in _CODES:
            yield field.name, kind, getattr(message, field.name)


def _fits(value: object, kind: str) -> bool:
    try:
        struct.pack(_CODES[kind], value)
    except Exception:  # whatever a class of a device's library raises as it is converted
        return isinstance(value, int)  # it is merely too large
    return True


class Calls:
    """The calls that are being made, by name; at most one of each name at a time."""

    def __init__(self, clock: Clock, limits_s: Mapping[str, float]) -> None:
        self._clock, self._limits_s = clock, dict(limits_s)
        self._begun_ns: dict[str, int] = {}

    def made(self, name: str, call: Callable[[], None]) -> str:
        """Make a call; what it raised as one line, or empty."""
        self._begun_ns[name] = self._clock.now_ns()
        try:
            call()
        except BaseException as error:  # also SystemExit and asyncio's CancelledError: a writer must not end unseen
            return fault_text(f"{name}: {type(error).__name__}: {_text_of(error)}")
        finally:
            self._begun_ns.pop(name, None)
        return ""

    def stalled(self, now_ns: int) -> str:
        """A call that has taken longer than its limit; empty if there is none."""
        for name, limit_s in self._limits_s.items():
            begun_ns = self._begun_ns.get(name)
            if begun_ns is not None and now_ns - begun_ns > limit_s * 1e9:
                return f"{name}: stalled for {limit_s:g} s"
        return ""


def _text_of(error: BaseException) -> str:
    """Text of an exception; a class of a device's library may fail to make one, and must not end a thread by it."""
    try:
        return str(error)
    except Exception as failure:
        return f"without a text, since its __str__ raises {type(failure).__name__}"
