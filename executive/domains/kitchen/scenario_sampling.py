"""Draws a kitchen scenario: the robot's start, displaced tables and cups, and events that disturb a run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from tailor.schemas.kitchen.furniture import Place, kitchen, on_table

Values = dict[str, float]


def sample_scenario(
    declared: Mapping[str, Any], rng: np.random.Generator
) -> tuple[Values, dict[str, Values], tuple[Values, ...]]:
    """Draw start state, places by label and events uniformly from the ranges of kitchen.toml and a scenario file.

    Args:
      declared: The scenario file: see scenarios/*.toml, which explain their own keys.
      rng: Source of every draw.

    Returns:
      Start state of robot, tables, stool and cups, places by label, and events; metres, radians, seconds, map frame.
    """
    start, tables = sample_kitchen(rng)
    cups = {}
    for cup, label in declared["cups"].items():
        table, slot = declared["settings"]["spots"][label]
        cups[cup] = tables[table]
        start |= stood(cup, sample_cup(tables[table], slot, rng))
    places = {label: {"v": 0.0, **place} for label, place in declared.get("stands", {}).items()}
    events = tuple(_event(row, start, cups, rng) for row in declared.get("events", ()))
    return start, places, events


def sample_kitchen(rng: np.random.Generator) -> tuple[Values, dict[str, Place]]:
    """Start of the robot, and displaced tables and stool; the tables also by name."""
    size = kitchen()
    start = dict(zip(("x", "y", "phi"), _displaced(size.start, size.start_displaced, rng), strict=True))
    tables = {name: _displaced(place, size.table.displaced, rng) for name, place in size.tables.items()}
    for name, place in tables.items():
        start |= {f"{name}_{q}": value for q, value in zip(("x", "y", "phi"), place, strict=True)}
    x, y = (at + rng.uniform(-by, by) for at, by in zip(size.stool.place, size.stool.displaced, strict=True))
    return {**start, "stool_x": float(x), "stool_y": float(y)}, tables


def sample_cup(table: Place, slot: int, rng: np.random.Generator) -> Place:
    """A cup near a slot of a table; its handle points away from the robot, roughly."""
    x, y = kitchen().table.slots[slot]
    return on_table(table, *_displaced((x, y, math.pi), kitchen().cup.displaced, rng))


def stood(cup: str, place: Place) -> Values:
    """Start values of a cup."""
    return {f"{cup}_{q}": value for q, value in zip(("x", "y", "phi"), place, strict=True)}


def _displaced(place: Place, by: Place, rng: np.random.Generator) -> Place:
    x, y, phi = (float(at + rng.uniform(-most, most)) for at, most in zip(place, by, strict=True))
    return x, y, math.remainder(phi, math.tau)


def _event(row: Mapping[str, Any], start: Values, cups: Mapping[str, Place], rng: np.random.Generator) -> Values:
    """An event: a cup is moved towards the middle of its table, a cup is pushed, or the next grasp fails."""
    event = {"at_s": float(rng.uniform(*row["between_s"]))}
    if "fumble" in row:
        return {**event, "fumble": float(row["fumble"])}
    cup, table = row["cup"], cups[row["cup"]]
    if "push_mps" in row:
        speed, angle = rng.uniform(*row["push_mps"]), rng.uniform(-math.pi, math.pi)
        return {**event, f"{cup}_vx": float(speed * math.cos(angle)), f"{cup}_vy": float(speed * math.sin(angle))}
    x, y = start[f"{cup}_x"], start[f"{cup}_y"]
    c, s = math.cos(table[2] + math.pi / 2), math.sin(table[2] + math.pi / 2)  # across the table
    aside = c * (x - table[0]) + s * (y - table[1])
    distance = -math.copysign(rng.uniform(*row["move_m"]), aside)
    return {**event, f"{cup}_x": float(x + distance * c), f"{cup}_y": float(y + distance * s)}
