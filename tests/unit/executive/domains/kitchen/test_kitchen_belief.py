"""The kitchen robot's belief of its own place, and of its gripper."""

from dataclasses import replace

import numpy as np
import pytest

from tailor.executive import domains
from tailor.executive.belief.angles import difference
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.kitchen import objects
from tailor.executive.domains.kitchen.objects import Thing
from tailor.executive.interfaces.domain_results import kept_at, relocations
from tailor.schemas.messages import PoseEstimate, Sample
from tailor.schemas.messages.kitchen import GripperState, ObjectPercept

PERIOD_NS = 100_000_000


def test_a_base_that_was_moved_is_believed_after_three_poses_and_counted():
    kitchen = domains.load("kitchen")
    belief, counts = kitchen.initial_belief(), []
    for n, x in enumerate([0.0] * 8 + [2.0] * 4 + [-1.0] * 3, start=1):
        pose = Sample("b21/pose", PoseEstimate(0, x, 0.0, 0.0, 1e-4, 1e-4, 1e-4), n * PERIOD_NS, n)
        belief = kitchen.update(belief, n * PERIOD_NS, (pose,), (0.0,) * len(kitchen.axes))
        counts.append(relocations(kitchen, belief))
    assert counts == [0] * 10 + [1] * 4 + [2]


@pytest.mark.parametrize(
    ("width", "force", "expected"), [(0.07, 3.0, 0.07), (0.07, 30.0, 0.066), (0.002, 30.0, 0.0), (0.1203, 0.0, 0.1203)]
)
def test_the_gripper_stays_as_wide_as_it_is_and_goes_on_pressing(width, force, expected):
    kitchen = domains.load("kitchen")
    belief = replace(kitchen.initial_belief(), width=width, force=force)
    assert kept_at(kitchen, belief) == pytest.approx((*(0.0,) * 8, expected))


@pytest.mark.parametrize(
    ("width", "force", "expected"),
    [(0.074, 30.0, "cup1"), (0.104, 30.0, "cup1"), (0.074, 0.5, ""), (0.02, 30.0, ""), (0.118, 30.0, "")],
)
def test_a_cup_is_held_across_its_body_or_its_handle(width, force, expected):
    kitchen = domains.load("kitchen")
    unknown = kitchen.initial_belief()
    cup = Thing("cup1", *unknown.hand, phi=0.0, tilt=0.0, var_xy=1e-4, seen_ns=0)
    gripper = Sample("b21/gripper", GripperState(0, width, force), PERIOD_NS, 1)
    belief = kitchen.update(replace(unknown, things=(cup,)), PERIOD_NS, (gripper,), (0.0,) * len(kitchen.axes))
    assert belief.held == expected


@pytest.mark.parametrize(("name", "z"), [("cup1", 0.77), ("table1", 0.72)])
@pytest.mark.parametrize(("turned", "sigma"), [(0.3, 0.02), (-1.5, 0.05), (3.1, 0.05)])
def test_an_object_that_was_turned_in_place_is_believed_so_at_once(name, z, turned, sigma):
    """After 5 s of looking, a handle was believed more than half the turn beside where it pointed."""
    rng, pose = np.random.default_rng(0), Pose(0.0, 0.0, 0.0, (1e-8, 0.0, 0.0, 1e-8, 0.0, 1e-8))
    things, believed = (), []
    for n in range(100):
        x, y, error = 0.8 + 0.004 * rng.normal(), 0.1 + 0.004 * rng.normal(), sigma * rng.normal()
        percept = ObjectPercept(name, x, y, z, turned * (n >= 90) + error, 0.02, 1.6e-5, 1.6e-5, sigma**2)
        things = objects.see(things, pose, (percept,), n * PERIOD_NS)
        believed.append(things[0].phi)
    assert max(map(abs, believed[30:90])) < 2 * sigma  # noise does not turn it
    assert max(abs(difference(each, turned)) for each in believed[90:]) < 4 * sigma
