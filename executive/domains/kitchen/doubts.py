"""Pictures by which an object would be elsewhere at once, or turned: something else was taken for it, or it moved."""

from __future__ import annotations

from collections.abc import Callable

from tailor.executive.belief.angles import wrap
from tailor.executive.domains.kitchen.belief import KitchenBelief
from tailor.executive.domains.kitchen.objects import TURNED_RAD, Thing, is_elsewhere


def _objects(before: KitchenBelief, after: KitchenBelief) -> bool:
    return any(_is_another(thing, seen) for thing in before.things if (seen := after.thing(thing.name)) is not None)


def _is_another(before: Thing, after: Thing) -> bool:
    """Whether it is farther off, in height too, than both are uncertain of, or has turned or fallen."""
    turned_rad = max(abs(wrap(after.phi - before.phi)), abs(after.tilt - before.tilt))
    return is_elsewhere(before, after) or turned_rad > TURNED_RAD


DOUBTS: dict[str, Callable[[KitchenBelief, KitchenBelief], bool]] = {"objects": _objects}
