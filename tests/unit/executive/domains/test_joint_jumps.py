"""Joints that are found where they cannot have moved to: whoever moved them, what was decided before is dropped."""

from __future__ import annotations

import pytest

from tailor.executive import domains
from tailor.executive.belief.joint_jumps import jumped
from tailor.executive.interfaces.domain_results import relocations
from tailor.schemas.messages import JointState, Sample

TICK_NS = 100_000_000


def counts(name, positions, velocity=0.0, tick_ns=TICK_NS):
    """Relocations after each of these readings of a domain's first joint, which comes at `velocity` (rad/s)."""
    domain = domains.load(name)
    joints = [axis.name for axis in domain.axes if axis.unit == "rad/s" and axis.name != "omega"]
    belief, found, rest = domain.initial_belief(), [], (0.0,) * (len(joints) - 1)
    for n, position in enumerate(positions, 1):
        state = JointState(0, tuple(joints), (position, *rest), (velocity, *rest), (0.0,) * len(joints))
        sample = Sample(f"{domain.robot}/joint_states", state, n * tick_ns, n)
        belief = domain.update(belief, n * tick_ns, (sample,), (0.0,) * len(domain.axes))
        found.append(relocations(domain, belief))
    return found


@pytest.mark.promise("P6")
@pytest.mark.parametrize("name", ["arm", "kitchen"])
def test_a_joint_that_jumps_counts_as_a_robot_that_was_carried(name):
    assert counts(name, [1.5, 1.5, 1.5, 1.0, 1.0, 1.5]) == [0, 0, 0, 1, 1, 2]


@pytest.mark.parametrize("name", ["arm", "kitchen"])
def test_a_joint_at_full_speed_does_not_jump_nor_one_that_is_stopped_at_once(name):
    assert counts(name, [0.0, 0.12, 0.24, 0.36, 0.36, 0.36], velocity=1.2) == [0] * 6


def test_after_a_pause_it_may_be_farther_away():
    assert counts("kitchen", [0.0, 0.5], tick_ns=4 * TICK_NS) == [0, 0]
    assert counts("kitchen", [0.0, 0.6], tick_ns=4 * TICK_NS) == [0, 1]


@pytest.mark.parametrize(("off", "is_jump"), [(0.219, False), (0.221, True), (-0.219, False), (-0.221, True)])
def test_the_limit_is_full_speed_and_a_tenth_of_a_radian(off, is_jump):
    assert jumped((0.3, 0.0), (0.3, off), 0.1, 1.2) is is_jump
