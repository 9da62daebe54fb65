"""Differences of two messages: the first different field, and whether they are equal except for rounding."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

from tailor.schemas.messages import RefinementReport

ROUNDING = 1e-9  # of 1 or of the value: errors of libm in the last bit (1e-16), amplified over a run
PROOF_ROUNDING_PCT = 0.01  # single-precision products of a bound (1e-7) decide which boxes a proof divides next
NONE = "none"  # in place of a message that one side lacks


@dataclass(frozen=True, slots=True)
class Difference:
    """First difference between a recording and the outputs of today's core."""

    tick: int
    key: str
    field: str
    recorded: str
    today: str

    @property
    def may_be_loss(self) -> bool:
        """Whether the recording may have lost what it lacks: no later message of the key shows its number."""
        return self.recorded == NONE and self.field == "message"

    def __str__(self) -> str:
        return f"tick {self.tick}, {self.key}, {self.field}: recorded {self.recorded}, today {self.today}"


def first_field(then: Any, now: Any) -> tuple[str, Any, Any]:
    """Name and values of the first different field of two messages; name "type" if their types differ."""
    if type(then) is not type(now):
        return "type", type(then).__name__, type(now).__name__
    for entry in dataclasses.fields(then):
        old, new = getattr(then, entry.name), getattr(now, entry.name)
        if old != new:
            return _first_element(entry.name, old, new)
    return "bytes", "different bytes for equal values", ""


def rounding_apart(then: Any, now: Any) -> bool:
    """Whether two values, messages or tuples are equal, except for at most `ROUNDING` in their numbers."""
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


def with_proof_of(then: Any, now: Any) -> Any:
    """The message `then`; with the gap of `now` where both have one, at most `PROOF_ROUNDING_PCT` apart."""
    if not (isinstance(then, RefinementReport) and isinstance(now, RefinementReport)):
        return then
    proven = min(then.gap_pct, now.gap_pct) >= 0
    near = abs(then.gap_pct - now.gap_pct) <= PROOF_ROUNDING_PCT
    return dataclasses.replace(then, gap_pct=now.gap_pct) if proven and near else then


def _first_element(name: str, old: Any, new: Any) -> tuple[str, Any, Any]:
    """First different element of nested tuples and messages, named e.g. "actions[0].parameters[2].value"."""
    if isinstance(old, tuple) and isinstance(new, tuple) and len(old) == len(new):
        index = next(i for i, pair in enumerate(zip(old, new, strict=True)) if pair[0] != pair[1])
        return _first_element(f"{name}[{index}]", old[index], new[index])
    if dataclasses.is_dataclass(old) and type(old) is type(new):
        inner, then, now = first_field(old, new)
        return f"{name}.{inner}", then, now
    return name, old, new
