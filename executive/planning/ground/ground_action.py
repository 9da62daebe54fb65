"""Ground actions and their effects; each step of a ground plan is an instance of one."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import NamedTuple

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.ground.ground_formula import GroundCondition
from tailor.executive.planning.pddl.language import When
from tailor.executive.planning.structures.connectives import conjunction

Span = tuple[int, int]  # first and last moment: 0 is the action's start, 1 its end
_SPANS: dict[When, Span] = {"start": (0, 0), "over": (0, 1), "end": (1, 1)}


def span_of(when: When, temporal: bool) -> Span:
    """Span of a condition or effect; if actions take no time (not `temporal`) all are at once."""
    return _SPANS[when] if temporal else (0, 0)


class GroundEffect(NamedTuple):  # a tuple: grounding makes and compares thousands
    """A literal that becomes true at a moment if `conditions` (each with its span) hold."""

    literal: int
    moment: int
    conditions: tuple[tuple[GroundCondition, Span], ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class GroundAction:
    """An action with objects for its parameters, without effects that achieve nothing (the no-op rule).

    Durations are in units of the time grid, `longest` is None without an upper limit; both are 0 if the
    domain has no durative actions. `bits` maps each literal that the action may make true to a bit mask of moments.
    `external_conditions` must be achieved by other steps: see the function of that name. `restored` are deletions of
    what the action adds again at that moment: no effects. `upheld` maps, as `bits` does, the literals that it makes
    true although its own conditions require them at that moment: no effects either.
    """

    number: int  # grounding order
    name: Fact
    conditions: tuple[tuple[GroundCondition, Span], ...]
    external_conditions: tuple[tuple[GroundCondition, Span], ...]
    effects: tuple[GroundEffect, ...]
    bits: dict[int, int]
    shortest: int = 0
    longest: int | None = 0
    duration_s: float = 0.0  # shortest duration
    simple: bool = True  # no conditional effects
    cost: float = 0.0  # by which it increases the total cost
    restored: tuple[GroundEffect, ...] = ()
    upheld: dict[int, int] = field(default_factory=dict)

    def __str__(self) -> str:
        return f"({' '.join(self.name)})"


def by_span(conditions: Iterable[tuple[GroundCondition, Span]]) -> dict[Span, GroundCondition]:
    """The conjunction of the conditions of each span."""
    spans: dict[Span, list[GroundCondition]] = {}
    for condition, span in conditions:
        spans.setdefault(span, []).append(condition)
    return {span: conjunction(own) for span, own in spans.items()}


def external_conditions(
    conditions: tuple[tuple[GroundCondition, Span], ...], effects: Iterable[GroundEffect]
) -> tuple[tuple[GroundCondition, Span], ...]:
    """The conditions of an action, without the later ones that its own start makes true."""
    own = {effect.literal for effect in effects if effect.moment == 0 and not effect.conditions}
    return tuple([(part, span) for part, span in conditions if span[1] == 0 or part not in own])
