"""A running course is kept while it is as likely to succeed as when it was decided, wherever objects seem to be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tailor.executive.refinement.course_check import from_here, risen_failure
from tailor.executive.refinement.objective.settings import RefinementSettings
from tests.unit.executive.refinement.synthetic_context import BESIDE, GO_AROUND, beside

START = {"x": -2.0, "y": 0.0, "phi": 0.0, "v": 0.0}
GOAL = {"x": 2.0, "y": 0.0, "phi": (-1.0, 1.0), "v": 0.0}
ASIDE = (0.0, 1.0, 0.2)
EXACT = RefinementSettings(arrival_spread=(), certify_checks=0)


def now(objects, start=START):
    return beside(objects, [GO_AROUND], [start, GOAL])


def likelier(objects, start=START, failure=(0.0,)) -> bool:
    decided = now((ASIDE,))
    values = {variable.id: 0.0 for variable in decided.free()}
    return risen_failure(decided, values, failure, now(objects, start), BESIDE, EXACT)[1]


@pytest.mark.parametrize(
    ("objects", "expected"),
    [
        ((ASIDE,), False),
        (((0.0, 0.8, 0.2),), False),  # it moved, and is still out of the way
        (((0.0, 0.1, 0.2),), True),
        ((ASIDE, (1.0, 0.0, 0.2)), True),  # a new one
        ((), False),
    ],
)
def test_only_an_object_in_the_way_matters(objects, expected):
    assert likelier(objects) is expected


def test_object_that_was_passed_does_not_matter():
    in_the_way = ((-1.0, 0.1, 0.2),)
    assert likelier(in_the_way)
    assert not likelier(in_the_way, {**START, "x": 0.5})


def test_risk_that_was_accepted_is_not_decided_anew():
    assert likelier(((0.0, 0.1, 0.2),))
    assert not likelier(((0.0, 0.1, 0.2),), failure=(0.99,))


def test_course_starts_from_the_state_of_now():
    decided, here = now((ASIDE,)), now(((0.5, 0.5, 0.2),), {**START, "x": 0.5, "v": 0.4})
    course = from_here(decided.bind({variable.id: 0.3 for variable in decided.free()}), here)
    first = course.actions[0]
    values = {p.name: course.variables[i].value for p, i in zip(first.action.parameters, first.variables, strict=True)}
    assert (values["x"], values["v"], values["xg"], values["phig"]) == (0.5, 0.4, 2.0, 0.3)
    assert np.allclose(first.context, here.actions[0].context)


def test_object_in_the_way_of_a_later_action_is_no_risk_of_the_running_one():
    places = [START, {**START, "x": 0.0}, {**START, "x": 2.0}]
    decided, seen = (beside((wall,), [GO_AROUND] * 2, places) for wall in (ASIDE, (1.0, 0.0, 0.2)))
    risk, risen = risen_failure(decided, {}, (0.0, 0.0), seen, BESIDE, EXACT)
    assert risen
    assert risk < 0.01


def test_price_is_that_of_meeting_the_object_and_nothing_where_failures_have_none():
    wall = now(((0.0, 0.1, 0.2),))
    values, unpriced = {variable.id: 0.0 for variable in wall.free()}, replace(EXACT, risk_cost_s=0.0)
    priced, free = (risen_failure(wall, values, (0.0,), wall, BESIDE, each) for each in (EXACT, unpriced))
    assert priced[0] > 0.9 * EXACT.risk_cost_s
    assert free == (0.0, True)
