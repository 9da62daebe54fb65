"""Pictures by which an object would be elsewhere at once, or turned: something else was taken for it, or it moved."""

from __future__ import annotations

from collections.abc import Callable

from tailor.executive.belief.angles import wrap
from tailor.executive.domains.kitchen.belief import KitchenBelief
from tailor.executive.domains.kitchen.objects import TURNED_RAD, Thing


def _objects(before: KitchenBelief, after: KitchenBelief) -> bool:
    return any(_begun_anew(thing, after.thing(thing.name)) for thing in before.things)


def _begun_anew(before: Thing, after: Thing | None) -> bool:
    """Whether a percept is all that is believed now: one that is fused leaves less variance, and turns little."""
    if after is None:
        return False
    turned = max(abs(wrap(after.phi - before.phi)), abs(after.tilt - before.tilt)) > TURNED_RAD
    return after.var_xy > before.var_xy or turned


DOUBTS: dict[str, Callable[[KitchenBelief, KitchenBelief], bool]] = {"objects": _objects}
