"""Where tables, cups and the stool are: as they were seen, else as the map of the kitchen has them."""

from __future__ import annotations

from tailor.executive.domains.kitchen.belief import KitchenBelief
from tailor.schemas.kitchen.furniture import Place, kitchen, on_table


def table_place(belief: KitchenBelief, name: str) -> Place:
    """Pose of a table, m and rad in the map frame."""
    seen = belief.thing(name)
    return kitchen().tables[name] if seen is None else (seen.x, seen.y, seen.phi)


def cup_place(belief: KitchenBelief, name: str) -> tuple[float, float, float]:
    """Middle of a cup, m in the map frame."""
    seen = belief.thing(name)
    if seen is not None:
        return seen.x, seen.y, seen.z
    x, y, _ = mapped_cup(belief, name)
    return x, y, kitchen().table.size[2] + kitchen().cup.height / 2


def mapped_cup(belief: KitchenBelief, name: str) -> Place:
    """Place of a cup, and direction of its handle, according to the map, on its table as it was seen."""
    table, slot, handle = kitchen().cups[name]
    return on_table(table_place(belief, table), *kitchen().table.slots[slot], handle)


def stool_place(belief: KitchenBelief) -> tuple[float, float]:
    """Middle of the stool, m in the map frame."""
    seen = belief.thing("stool")
    return kitchen().stool.place if seen is None else (seen.x, seen.y)
