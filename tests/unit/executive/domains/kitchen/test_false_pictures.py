"""Which pictures of the kitchen are doubted: those by which an object that has been seen would be another one."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tailor.executive import domains
from tests.unit.executive.domains.kitchen.test_phantoms import believed, percept

DOUBTS = domains.doubts("kitchen")["objects"]
CUP = percept("cup1", 1.0)


def doubted(*pictures):
    """Whether the last picture is."""
    return DOUBTS(believed(*pictures[:-1]), believed(*pictures))


def test_what_is_seen_for_the_first_time_or_again_or_not_is_believed():
    assert not doubted([], [CUP])
    assert not doubted([CUP], [CUP, percept("stool", 2.0)])
    assert not doubted([CUP], [replace(CUP, x=1.01, phi=0.05, tilt=0.05)])
    assert not doubted([CUP], [])


@pytest.mark.parametrize(
    "change", [{"x": 1.3}, {"y": -0.2}, {"z": CUP.z + 0.2}, {"phi": 1.0}, {"phi": -1.0}, {"tilt": 1.2}]
)
def test_an_object_that_would_be_elsewhere_or_turned_or_down_at_once_is_doubted(change):
    assert doubted([CUP], [CUP], [replace(CUP, **change), percept("stool", 2.0)])


def test_a_direction_is_a_matter_of_the_full_turn():
    assert not doubted([replace(CUP, phi=3.13)], [replace(CUP, phi=-3.13)])


def test_the_noise_of_a_far_object_is_none_of_another_one():
    """Its height alone may be off by more than an object that is near could be without being moved."""
    far = replace(percept("stool", 4.0, z=0.6), var_xy=0.01)
    assert not doubted([far], [replace(far, x=4.2, z=0.9)])
    assert doubted([far], [far], [replace(far, x=5.0)])


def test_a_far_object_whose_height_is_noise_is_fused_with_what_was_seen_of_it():
    far = replace(percept("stool", 4.0, z=0.6), var_xy=0.01)
    seen = believed([far], [replace(far, x=4.2, z=0.9)]).thing("stool")
    assert seen.var_xy < believed([far]).thing("stool").var_xy
    assert 0.6 < seen.z < 0.9


def test_an_object_that_was_lifted_is_where_it_is_seen_at_once():
    assert believed([CUP], [CUP], [replace(CUP, z=CUP.z + 0.2)]).thing("cup1").z == CUP.z + 0.2
