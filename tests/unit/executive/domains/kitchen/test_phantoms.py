"""Objects of names that there are not in the kitchen: they hide no cup, and none of them is taken for a cup."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tailor.executive import domains
from tailor.executive.domains.kitchen.action_library import GRIP_CUP
from tailor.schemas.kitchen.furniture import kitchen
from tailor.schemas.kitchen.kinematics import HOME, JOINTS
from tailor.schemas.messages import JointState, PoseEstimate, Sample
from tailor.schemas.messages.kitchen import GripperState, ObjectPercept, ObjectPercepts

KITCHEN = domains.load("kitchen")
TICK_NS = 100_000_000
CUP_M = kitchen().table.size[2] + kitchen().cup.height / 2
OPEN = GripperState(0, 0.12, 0.0)
SHUT = GripperState(0, 0.07, 30.0)  # as wide as a cup, and it presses something


def percept(name, x, y=0.0, z=CUP_M):
    return ObjectPercept(name, x, y, z, 0.0, 0.0, 1e-6, 1e-6, 1e-6)


def believed(*pictures, gripper=OPEN):
    """The belief of a robot at the map's origin after some pictures."""
    belief = KITCHEN.initial_belief()
    for n, objects in enumerate(pictures, 1):
        readings = (
            PoseEstimate(0, 0.0, 0.0, 0.0, 1e-6, 1e-6, 1e-6),
            JointState(0, JOINTS, HOME, (0.0,) * 6, (0.0,) * 6),
            ObjectPercepts(0, tuple(objects)),
            gripper,
        )
        samples = tuple(Sample(f"b21/{k}", message, n * TICK_NS, n) for k, message in enumerate(readings))
        belief = KITCHEN.update(belief, n * TICK_NS, samples, (0.0,) * len(KITCHEN.axes))
    return belief


def test_any_number_of_phantoms_hides_no_cup():
    phantoms = [percept(f"thing{n}", 1.0) for n in range(3000)]
    seen = believed(phantoms, [*phantoms, percept("cup1", 0.8)])
    assert [thing.name for thing in seen.things] == ["cup1"]


@pytest.mark.parametrize("name", ["cupboard", "cup9", "cup", "cup1 "])
def test_nothing_but_a_cup_of_the_kitchen_is_in_the_gripper(name):
    x, _, z = KITCHEN.initial_belief().hand
    assert believed([percept(name, x, 0.0, z)], gripper=SHUT).held == ""
    assert believed([percept("cup2", x, 0.0, z)], gripper=SHUT).held == "cup2"


@pytest.mark.parametrize("name", ["cupboard", "cup9"])
def test_nothing_but_a_cup_of_the_kitchen_is_gripped(name):
    """The hand goes to the cup although something of another name is nearer to the spot."""
    spot = (0.75, 0.1)
    goals = []
    for objects in ([percept("cup1", 0.72, 0.12)], [percept("cup1", 0.72, 0.12), percept(name, *spot)]):
        arguments = np.array([0.0, 0.0, 0.0, *spot, 0.0, 0.0, 0.0])
        goals.append(GRIP_CUP.controller(None, 0, believed(objects), arguments).state.goal)
    assert goals[0] == goals[1]
    assert math.isfinite(sum(goals[0]))
