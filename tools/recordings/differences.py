"""Where two messages differ: the first field, and whether rounding may be all that lies between them."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

ROUNDING = 1e-9  # of 1 or of the value: last bits (1e-16), grown over a run; what the machines' libm may account for


@dataclass(frozen=True, slots=True)
class Difference:
    """The first place where today's core says something else."""

    tick: int
    key: str
    field: str
    recorded: str
    today: str

    def __str__(self) -> str:
        return f"tick {self.tick}, {self.key}, {self.field}: recorded {self.recorded}, today {self.today}"


def first_field(then: Any, now: Any) -> tuple[str, Any, Any]:
    """Name and both values of the first field in which two messages differ; "type" if they are of two types."""
    if type(then) is not type(now):
        return "type", type(then).__name__, type(now).__name__
    for entry in dataclasses.fields(then):
        old, new = getattr(then, entry.name), getattr(now, entry.name)
        if old != new:
            return _first_element(entry.name, old, new)
    return "bytes", "other bytes for the same values", ""


def rounding_apart(then: Any, now: Any) -> bool:
    """Whether two values, messages or tuples differ by no more than `ROUNDING` in any number, and in nothing else."""
    if type(then) is not type(now):
        return False
    if isinstance(then, float):
        return bool(abs(then - now) <= ROUNDING * max(1.0, abs(then)) or then == now)
    if isinstance(then, tuple):
        return len(then) == len(now) and all(map(rounding_apart, then, now))
    if dataclasses.is_dataclass(then):
        fields = dataclasses.fields(then)
        return all(rounding_apart(getattr(then, entry.name), getattr(now, entry.name)) for entry in fields)
    return bool(then == now)


def _first_element(name: str, old: Any, new: Any) -> tuple[str, Any, Any]:
    """Goes into tuples and messages inside a message: "belief[3]", "actions[0].parameters[2].value"."""
    if isinstance(old, tuple) and isinstance(new, tuple) and len(old) == len(new):
        place = next(i for i, pair in enumerate(zip(old, new, strict=True)) if pair[0] != pair[1])
        return _first_element(f"{name}[{place}]", old[place], new[place])
    if dataclasses.is_dataclass(old) and type(old) is type(new):
        inner, then, now = first_field(old, new)
        return f"{name}.{inner}", then, now
    return name, old, new
