"""A choice is outdated when the belief has moved a range of the running action off it, modulo a full turn."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tailor.executive.interfaces.action import Parameter
from tailor.executive.interfaces.values import Interval
from tailor.executive.refinement.belief_monitor import BeliefMonitor
from tailor.executive.refinement.instantiation import Pattern
from tailor.executive.refinement.objective.sequence import Variable
from tailor.executive.refinement.range_monitor import outside
from tests.support.synthetic_models import PI
from tests.unit.executive.refinement.test_instantiation import PaperDomain, paper_plan

PLACE = Parameter("x", 0, "x", "m", -5.0, 5.0)
ANGLE = Parameter("phi", 0, "phi", "rad", -PI, PI, periodic=True)


def variable(lower, upper, periodic=False):
    return Variable(0, "a", "x", "m", lower, upper, periodic, lower if lower == upper else None)


@pytest.mark.parametrize(
    ("value", "lower", "upper", "expected"),
    [(1.0, 0.0, 1.0, False), (1.09, 0.0, 1.0, False), (1.11, 0.0, 1.0, True), (-0.11, 0.0, 1.0, True)],
)
def test_a_tenth_of_the_range_is_tolerated(value, lower, upper, expected):
    assert outside(value, variable(lower, upper), PLACE) is expected


def test_tolerance_of_the_parameter_counts_where_it_has_one():
    assert not outside(1.3, variable(0.0, 1.0), replace(PLACE, tolerance=0.4))
    assert outside(1.03, variable(0.0, 1.0), replace(PLACE, tolerance=0.02))


def test_bound_variable_has_no_range_that_could_be_left():
    assert not outside(1.0, variable(3.0, 3.0), PLACE)


@pytest.mark.parametrize(
    ("value", "expected"), [(3.6, False), (3.6 - 2 * PI, False), (2.4, True), (3.9 - 2 * PI, True)]
)
def test_angles_are_compared_modulo_a_full_turn(value, expected):
    assert outside(value, variable(2.64, 3.64), ANGLE) is expected
    assert outside(value, variable(2.64 - 2 * PI, 3.64 - 2 * PI), ANGLE) is expected


def test_angle_whose_full_turn_is_free_is_never_outside():
    assert not any(outside(value, variable(-PI, PI, True), ANGLE) for value in (-9.0, -PI, 0.0, PI, 9.0))


class Sectors(PaperDomain):
    """The heading at the ball and at the end are free within half a radian of what the belief states."""

    def value(self, query):
        if query.quantity == "phi" and query.label in ("pos2", "pos3"):
            return Interval(query.belief[query.label] - 0.5, query.belief[query.label] + 0.5)
        return super().value(query)


START = {"pos2": 0.0, "pos3": 0.0}


@pytest.mark.parametrize(
    ("belief", "expected"), [({"pos2": 0.09}, False), ({"pos2": 0.7}, True), ({"pos3": 0.7}, False)]
)
def test_only_ranges_of_the_first_action_are_monitored(belief, expected):
    pattern = Pattern(paper_plan(), Sectors(), None)
    sequence = pattern.sequence(START)
    chosen = {variable.id: variable.lower for variable in sequence.free()}
    assert BeliefMonitor(pattern, sequence).outdated({**START, **belief}, chosen) is expected
