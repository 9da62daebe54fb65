"""A robot that is faster than its drives may begin rolls on before it obeys."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tailor.executive.interfaces.action import Action
from tailor.executive.refinement.rolling_start import ROLL_S, begins_too_fast, rolled_on
from tests.support.synthetic_models import GO, sequence

GOAL = {"x": 2.0, "y": 0.0, "phi": 0.0, "v": 0.0}


def at_rest(action: Action) -> Action:
    """The same action, whose drives begin and end at rest."""
    parameters = (replace(each, upper=0.0) if each.quantity == "v" else each for each in action.parameters)
    return replace(action, parameters=tuple(parameters))


def course(action: Action, v: float):
    return sequence([action], [{"x": 0.5, "y": -0.25, "phi": 0.0, "v": v}, GOAL])


@pytest.mark.parametrize(("v", "too_fast"), [(0.0, False), (0.04, False), (0.06, True), (0.4, True)])
def test_drive_that_begins_at_rest_may_hardly_begin_faster(v, too_fast):
    assert begins_too_fast(course(at_rest(GO), v)) is too_fast
    assert (rolled_on(course(at_rest(GO), v)) is not None) is too_fast


def test_drive_that_may_begin_in_motion_is_never_too_fast():
    assert not begins_too_fast(course(GO, 0.4))
    assert rolled_on(course(GO, 0.4)) is None


def test_robot_rolls_on_ahead_and_the_rest_of_the_course_stays():
    before = course(at_rest(GO), 0.4)
    after = rolled_on(before)
    assert [each.value for each in after.variables[:4]] == pytest.approx([0.5 + ROLL_S * 0.4, -0.25, 0.0, 0.4])
    assert after.variables[4:] == before.variables[4:]
    assert after.actions == before.actions


def test_robot_rolls_on_for_the_speed_alone_at_which_drives_may_not_begin():
    """AGILO drives at 0.9 m/s, and its models know starts up to 0.6 m/s: it is soon as slow as that."""
    upper_mps = next(each.upper for each in GO.parameters if each.quantity == "v")
    after = rolled_on(course(GO, upper_mps + 0.3))
    assert [each.value for each in after.variables[:3]] == pytest.approx([0.5 + ROLL_S * 0.3, -0.25, 0.0])


def test_action_that_starts_from_no_pose_never_rolls():
    parameters = tuple(replace(each, quantity=f"joint_{each.name}") for each in at_rest(GO).parameters)
    reach = replace(at_rest(GO), parameters=parameters)
    assert not begins_too_fast(course(reach, 0.4))
    assert rolled_on(course(reach, 0.4)) is None
