"""Task sampler of the kitchen robot (paper 5.1): drives between stands, and what the arm does at a spot."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tailor.executive.actions.planar import PHI, PHIG, VG, XG, YG, V, X, Y
from tailor.executive.belief.angles import wrap
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.kitchen import places
from tailor.executive.domains.kitchen.action_library import ASIDE_RAD
from tailor.executive.domains.kitchen.arm_tasks import BACK_M, HANDLE, OUT, OVER_M, Hand
from tailor.executive.domains.kitchen.belief import FIRST_POSES, KitchenBelief
from tailor.executive.domains.kitchen.drive_to_stand import DriveToStand
from tailor.executive.domains.kitchen.objects import Thing
from tailor.executive.domains.kitchen.places import Spot
from tailor.executive.domains.kitchen.scenario_sampling import sample_kitchen
from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.values import Array
from tailor.schemas.errors import UsageError
from tailor.schemas.kitchen.furniture import kitchen, on_table
from tailor.schemas.kitchen.kinematics import JOINTS
from tailor.schemas.messages import Message
from tailor.schemas.messages.kitchen import KitchenTruth
from tailor.tools.lockstep.samplers import furniture, outlines
from tailor.tools.lockstep.samplers.beside import Beside
from tailor.tools.lockstep.samplers.free_drives import free_drive
from tailor.tools.lockstep.samplers.kitchen_outcomes import KitchenOutcomes

IN_MOTION = 0.5  # share of the drives in the open that begin, and of those that end, in motion
IN_OPEN = 0.6  # share of the drives that lead through the open; elsewhere one in motion would often touch something
FROM_START = 0.3  # share of the others that begin, or end, away from tables
END_TICKS = 10  # a drive that ends right here is judged each tick, and a false alarm there leads to a new one
BESIDE_STAND = {"x": 0.04, "y": 0.04, "phi": 0.1}  # by which a stand may lie outside of its ranges: drives arrive so
BETWEEN_STANDS = 0.4  # share of the drives among objects
CUP = "cup1"
ASIDE_STOOL = {"stool_x": 2.75, "stool_y": -1.95}  # in a corner: the duration of a drive is that of one with a free way


@dataclass(frozen=True, slots=True)
class KitchenSampler(KitchenOutcomes):
    """See task_sampler.TaskSampler."""

    def sample(self, action: Action, rng: np.random.Generator) -> Array:
        """Controller arguments: a drive between stands, the start or in the open, or a spot and a stand before it."""
        if action.name == "goToPose":
            return _through_open(action, rng) if rng.random() < IN_OPEN else _between_stands(rng)
        spot, handle = _spot(rng)
        arguments = [*_stand(spot, rng), spot.x, spot.y, rng.uniform(-ASIDE_RAD, ASIDE_RAD)]
        arguments += [float(rng.integers(2)), handle][: len(action.parameters) - len(arguments)]
        return np.array(arguments)

    def start(self, action: Action, arguments: Array, rng: np.random.Generator) -> dict[str, float]:
        """Start state of the body: the table of the spot stands under it; the arm is out where the arguments say so."""
        x, y, phi, *others = arguments.tolist()
        start = {"x": x, "y": y, "phi": phi, "width": 0.0}
        if action.name == "goToPose":
            return {**start, **ASIDE_STOOL, "v": others[0], "held": float(rng.integers(2))}
        start |= _table_under(others[0], others[1], rng)
        if action.name == "put":
            start["held"] = 1.0
        elif action.name == "grip":
            start |= {f"{CUP}_x": others[0], f"{CUP}_y": others[1], f"{CUP}_phi": arguments[HANDLE].item()}
        if action.name == "fold" or (action.name != "reach" and arguments[OUT] > 0.5):
            angles = Hand(OVER_M, BACK_M)(KitchenBelief(pose=_exact(start)), arguments)
            start |= {} if angles is None else dict(zip(JOINTS, angles, strict=True))
        return start

    def sample_among_objects(self, action: Action, rng: np.random.Generator) -> Array:
        """As `sample`, or anywhere in the open: an asserted subgoal may lie anywhere."""
        return _between_stands(rng) if rng.random() < BETWEEN_STANDS else _through_open(action, rng)

    def beside(self, action: Action, truths: Sequence[Message], count: int, rng: np.random.Generator) -> list[Beside]:
        """Furniture beside a drive; half of it beside its rest from some tick on, half of this beside its end."""
        ways = np.array([(truth.x, truth.y, truth.phi) for truth in truths if isinstance(truth, KitchenTruth)])
        last = max(0, len(ways) - END_TICKS)
        ticks = [0 if k % 2 else int(rng.integers(last if k % 4 else 0, len(ways))) for k in range(count)]
        return [furniture.beside(ways[tick:], tick, rng) for tick in ticks]

    def context(self, action: Action, arguments: Array, rng: np.random.Generator) -> Array:
        """A piece of furniture near the straight way, as it is believed."""
        ends = np.array([arguments[[X, Y, PHI]], arguments[[XG, YG, PHIG]]])
        return furniture.beside(ends[0] + np.linspace(0.0, 1.0, 50)[:, None] * (ends[1] - ends[0]), 0, rng).row

    def context_start(self, action: Action, row: Array, rng: np.random.Generator) -> dict[str, float]:
        """The stool at that place; its error in the belief is in the row.

        Raises:
          UsageError: The row is that of a box, and no furniture of that size can be put anywhere.
        """
        if row[outlines.LONG] > 0.0:
            raise UsageError("the kitchen has no furniture of any size: gather with --beside-objects N instead")
        return {"stool_x": float(row[0]), "stool_y": float(row[1])}

    def belief(self, start: Mapping[str, float], rng: np.random.Generator) -> KitchenBelief:
        """The belief after a look around: the robot knows itself, and where the cup is (Table 5)."""
        unknown = KitchenBelief()
        angles = tuple(start.get(joint, angle) for joint, angle in zip(JOINTS, unknown.angles, strict=True))
        believed = replace(unknown, pose=_exact(start), v=start.get("v", 0.0), poses_seen=FIRST_POSES, angles=angles)
        believed = replace(believed, joints_ns=1, held=CUP if start.get("held") else "", width=2 * kitchen().cup.radius)
        if f"{CUP}_x" not in start:
            return believed
        z = kitchen().table.size[2] + kitchen().cup.height / 2
        x, y, phi = (start[f"{CUP}_{q}"] for q in ("x", "y", "phi"))
        return replace(believed, things=(Thing(CUP, x, y, z, phi, 0.0, 1e-5, 0),))

    def arguments_now(self, action: Action, belief: KitchenBelief, arguments: Array) -> list[float]:
        """Training example: the drive from where the robot is now, decided by what it had seen at the start.

        What the arm does does not move the stand.
        """
        if action.name != "goToPose":
            return list(arguments.tolist())
        pose = belief.pose
        return [pose.x, pose.y, pose.phi, max(0.0, belief.v), *arguments[XG:].tolist()]


def _spot(rng: np.random.Generator) -> tuple[Spot, float]:
    """A spot at a slot of a displaced table, and the direction of a cup's handle there."""
    _, tables = sample_kitchen(rng)
    table = tables[rng.choice(sorted(tables))]
    x, y = kitchen().table.slots[int(rng.integers(len(kitchen().table.slots)))]
    off = [rng.uniform(-by, by) for by in kitchen().cup.displaced]
    at_x, at_y, handle = on_table(table, x + off[0], y + off[1], math.pi + off[2])
    return Spot(table, at_x, at_y), handle


def _stand(spot: Spot, rng: np.random.Generator) -> tuple[float, float, float]:
    ranges = places.stand_ranges(spot)
    x, y, phi = (rng.uniform(ranges[q].lower - by, ranges[q].upper + by) for q, by in BESIDE_STAND.items())
    return x, y, wrap(phi)


def _between_stands(rng: np.random.Generator) -> Array:
    return np.array([*_anywhere(rng), 0.0, *_anywhere(rng), 0.0, float(rng.integers(2))])


def _through_open(action: Action, rng: np.random.Generator) -> Array:
    """A drive whose planned way keeps clear of everything; at rest or in motion at either end."""
    controller: DriveToStand = action.controller  # type: ignore[assignment]
    arguments = free_drive(controller, rng)
    for at in (V, VG):
        arguments[at] = rng.uniform(0.0, action.parameters[at].upper) if rng.random() < IN_MOTION else 0.0
    return arguments


def _anywhere(rng: np.random.Generator) -> tuple[float, float, float]:
    if rng.random() < FROM_START:
        start, _ = sample_kitchen(rng)
        return start["x"], start["y"], start["phi"]
    return _stand(_spot(rng)[0], rng)


def _table_under(x: float, y: float, rng: np.random.Generator) -> dict[str, float]:
    """Start values of the nearest table, so that it has a slot at this spot."""
    name, (_, _, phi) = min(kitchen().tables.items(), key=lambda each: math.dist(each[1][:2], (x, y)))
    ahead, aside = kitchen().table.slots[0][0], rng.uniform(-0.2, 0.2)
    at_x, at_y, _ = on_table((x, y, phi), -ahead, -aside)
    return {f"{name}_x": at_x, f"{name}_y": at_y, f"{name}_phi": phi}


def _exact(start: Mapping[str, float]) -> Pose:
    return Pose(start["x"], start["y"], start["phi"], (1e-8, 0.0, 0.0, 1e-8, 0.0, 1e-8))
