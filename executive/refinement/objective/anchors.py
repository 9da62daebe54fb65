"""Places that an action begins or ends at, as values of the free place at its other end.

The way to a subgoal at such a place, or away from it, is short: there the cost has narrow minima that few random
candidates meet.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.stage import Stage


@dataclass(frozen=True, slots=True)
class Anchor:
    """A place: `values` of the k `columns` of a candidate."""

    columns: tuple[int, ...]
    values: Array


def anchors(stages: Sequence[Stage]) -> tuple[Anchor, ...]:
    """The fixed places of all stages for the free places at their other ends."""
    return tuple(anchor for stage in stages for anchor in _anchors(stage))


def _anchors(stage: Stage) -> Iterator[Anchor]:
    parameters = stage.action.parameters
    free = {int(slot): int(stage.columns[source]) for slot, source in zip(stage.slots, stage.sources, strict=True)}
    lengths = [slot for slot, parameter in enumerate(parameters) if parameter.unit == "m"]
    for end in sorted({parameters[slot].argument for slot in lengths}):
        place = {parameters[slot].quantity: slot for slot in lengths if parameters[slot].argument == end}
        if any(slot in free for slot in place.values()):
            continue
        other = {column: place.get(parameters[slot].quantity) for slot, column in free.items() if slot in lengths}
        shared = {column: slot for column, slot in other.items() if slot is not None}
        if shared:
            yield Anchor(tuple(shared), stage.template[list(shared.values())])
