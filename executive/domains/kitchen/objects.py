"""Cups, tables and stool as the kitchen robot believes them: where they stand in the map, seen or held."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache

from tailor.executive.belief.angles import wrap
from tailor.executive.belief.planar_ekf import Pose
from tailor.schemas.kitchen.furniture import kitchen
from tailor.schemas.messages.kitchen import ObjectPercept

VARIANCES = (1e-8, 1.0)  # of a percept, whatever was received
MOVED_SIGMAS, MOVED_M = 5.0, 0.04  # a percept farther off than both is not noise: the object was moved
TURNED_RAD = 0.15  # nor is a direction that is off by more than this and as many sigmas: the object was turned
LEAST_M2 = 1e-7  # variance below which no estimate falls, so that it can still follow
CREDIBLE_M = 20.0
PUT_DOWN_M = 0.05  # from the height at which a cup stands on a table


@dataclass(frozen=True, slots=True)
class Thing:
    """One object: its pose in the map frame as in ObjectPercept (m, rad), and the variance of x and y."""

    name: str
    x: float
    y: float
    z: float
    phi: float
    tilt: float
    var_xy: float
    seen_ns: int


def see(things: tuple[Thing, ...], pose: Pose, percepts: tuple[ObjectPercept, ...], now_ns: int) -> tuple[Thing, ...]:
    """Fuse a picture, taken from a pose; objects stay where they are until they are seen elsewhere."""
    known = {thing.name: thing for thing in things}
    for percept in percepts:
        if math.hypot(percept.x, percept.y) < CREDIBLE_M and percept.name in _names():
            credible_rad = max(TURNED_RAD, MOVED_SIGMAS * math.sqrt(max(0.0, percept.var_phi)))
            known[percept.name] = _fused(known.get(percept.name), _in_map(percept, pose, now_ns), credible_rad)
    return tuple(known[name] for name in sorted(known))


@cache
def _names() -> frozenset[str]:
    """What there is in the kitchen; a detector finds other things too, however many."""
    return frozenset((*kitchen().tables, *kitchen().cups, "stool"))


def named(things: tuple[Thing, ...], name: str) -> Thing | None:
    """The object of a name; None if it was never seen."""
    return next((thing for thing in things if thing.name == name), None)


def cups(things: tuple[Thing, ...]) -> tuple[Thing, ...]:
    """The cups among the objects."""
    return tuple(thing for thing in things if thing.name in kitchen().cups)


def carried(things: tuple[Thing, ...], name: str, x: float, y: float, z: float) -> tuple[Thing, ...]:
    """The objects, of which the one of that name is at a place in the map."""
    return tuple(replace(thing, x=x, y=y, z=z) if thing.name == name else thing for thing in things)


def let_go(things: tuple[Thing, ...], name: str) -> tuple[Thing, ...]:
    """The objects after a cup has left the gripper: one that was not put down may be anywhere until it is seen."""
    stands_m = kitchen().table.size[2] + kitchen().cup.height / 2
    return tuple(thing for thing in things if thing.name != name or abs(thing.z - stands_m) < PUT_DOWN_M)


def _in_map(percept: ObjectPercept, pose: Pose, now_ns: int) -> Thing:
    c, s = math.cos(pose.phi), math.sin(pose.phi)
    x, y = pose.x + c * percept.x - s * percept.y, pose.y + s * percept.x + c * percept.y
    lower, upper = VARIANCES
    heading_m2 = max(0.0, pose.covariance[5]) * (percept.x**2 + percept.y**2)
    var_xy = min(upper, max(lower, percept.var_xy) + max(0.0, pose.covariance[0]) + heading_m2)
    return Thing(percept.name, x, y, percept.z, wrap(pose.phi + percept.phi), percept.tilt, var_xy, now_ns)


def is_elsewhere(old: Thing, new: Thing) -> bool:
    """Whether an object was moved: it is seen farther off, in height too, than both places are uncertain."""
    off_m = math.dist((old.x, old.y, old.z), (new.x, new.y, new.z))
    return off_m > max(MOVED_M, MOVED_SIGMAS * math.sqrt(old.var_xy + new.var_xy))


def _fused(old: Thing | None, new: Thing, credible_rad: float) -> Thing:
    """An object as it is believed and seen; one that was moved is where it is seen, one turned points as it does."""
    if old is None or is_elsewhere(old, new):
        return new
    gain, turned = old.var_xy / (old.var_xy + new.var_xy), wrap(new.phi - old.phi)
    return Thing(
        old.name,
        old.x + gain * (new.x - old.x),
        old.y + gain * (new.y - old.y),
        old.z + gain * (new.z - old.z),
        new.phi if abs(turned) > credible_rad else wrap(old.phi + gain * turned),
        new.tilt,
        max(LEAST_M2, (1.0 - gain) * old.var_xy),
        new.seen_ns,
    )
