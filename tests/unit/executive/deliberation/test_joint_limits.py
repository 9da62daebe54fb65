"""Actions that succeed with different values of what they share: each alone is feasible, both together are risky."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tailor.executive.core.state import initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.action import Action, Parameter
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.assertion.assertion import HOPELESS
from tailor.executive.refinement.assertion.relaxed_limits import relaxed
from tailor.executive.refinement.objective.settings import RefinementSettings
from tests.support.toy_domain import LineDomain, LineModel, inputs, line_context, slide
from tests.unit.executive.refinement.synthetic_context import GO_AROUND, beside

TICK = 100_000_000
SLOW_MPS = 0.3
# the speed at a place belongs to the slide that ends there and to the one that begins there
SLIDE = Action(
    "slide",
    (
        Parameter("x", 0, "x", "m", -10, 100),
        Parameter("xg", 1, "x", "m", -10, 100),
        Parameter("vg", 1, "v", "m/s", 0.1, 0.5),
        Parameter("v", 0, "v", "m/s", 0.1, 0.5),
    ),
    slide,
    "slide/duration",
    "slide/success",
)


class FastInSlowOut:
    """Success: to a for sure above SLOW_MPS, from there on for sure below it; the rest fails with one probability."""

    def __init__(self, failure: float) -> None:
        self.failure = failure

    def probability(self, arguments):
        to_a = arguments[:, 1] < 0.75
        well = np.where(to_a, arguments[:, 2] > SLOW_MPS, arguments[:, 3] < SLOW_MPS)
        return np.where(well, 0.999, 1.0 - self.failure)


class Line(LineDomain):
    actions = {"slide": SLIDE}


def after_decision(failure: float, **given: float):
    """The task once it has been deliberated."""
    settings = Settings(refinement=RefinementSettings(arrival_spread=(), **given))
    models = Models({"slide/duration": LineModel()}, {"slide/success": FastInSlowOut(failure)})
    context = replace(line_context(settings), domain=Line(), models=models)
    state = initial_state(context)
    for n in range(1, 13):
        goal = context.problem.goal_text if n == 1 else ""
        state, _ = step(context, state, n * TICK, inputs(n * TICK, 0.0, goal), CheckBudget(3000))
    return state.task


@pytest.mark.parametrize("failure", [0.07, 0.3, 0.5])
def test_the_least_expected_cost_is_taken_up_to_the_risk_that_is_settled_for(failure):
    task = after_decision(failure)
    assert task.running is not None, task.result_text
    assert task.decision.choice.valid
    assert max(task.decision.choice.failure) == pytest.approx(failure)


def test_a_greater_risk_is_no_valid_choice():
    assert after_decision(0.6).result_text == "failed: no valid choice"
    assert after_decision(0.6, p_fail_settle=0.7).running is not None


def test_limits_are_kept_where_a_choice_keeps_them():
    task = after_decision(0.05)
    assert [action.risk for action in task.decision.sequence.actions] == [0.06, 0.06]


def test_among_objects_all_but_what_is_hopeless_is_weighed():
    places = [{"x": -2.0, "y": 0.0, "phi": 0.0, "v": 0.0}, {"x": 2.0, "y": 0.0, "phi": 0.0, "v": 0.0}]
    direct = beside([(0.0, 0.0, 0.3)], [GO_AROUND], places)
    wide = relaxed(direct, RefinementSettings())
    assert [action.risk for action in wide.actions] == [HOPELESS]
    assert relaxed(wide, RefinementSettings()) is None
