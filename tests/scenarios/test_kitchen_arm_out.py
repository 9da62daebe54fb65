"""An executive that starts while the arm is out, e.g. after it was killed in the middle of a grip."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tailor.executive import domains
from tailor.executive.deliberation.context import Settings, make_context
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.models.runtime import load_robot
from tailor.schemas.kitchen.kinematics import JOINTS
from tailor.simnodes.world import World
from tailor.tools.lockstep.bodies import body_of
from tailor.tools.lockstep.run import SENDER, run_lockstep

OUT = (0.0, 1.28, -1.82, 0.0, 0.54, 0.0)  # the hand ahead, above a table's top
GREEDY = Settings(refinement=replace(RefinementSettings(), horizon=1, certify_checks=0))
BEFORE_TABLE1 = {"x": -1.35, "y": 0.1, "phi": 3.14}
IN_THE_OPEN = {"x": 0.2, "y": 0.3, "phi": 0.4}


@pytest.mark.parametrize(
    "start",
    [BEFORE_TABLE1, IN_THE_OPEN, {**BEFORE_TABLE1, "held": 1.0}],
    ids=["before a table", "before no place", "with a cup in the gripper"],
)
def test_the_arm_comes_home_and_the_goal_is_reached(start):
    scenario, drawn = domains.seeded_scenario("kitchen", "one-cup", 3)
    context = make_context(domains.load("kitchen"), scenario, Models(*load_robot("b21")), GREEDY, SENDER)
    world = World(body_of("kitchen", ""), {**drawn, **dict(zip(JOINTS, OUT, strict=True)), **start}, 3, ())
    run = run_lockstep(context, world, limit_s=120.0)
    assert run.result == "achieved"
    assert (run.finished[0].action, run.finished[0].outcome) == ("fold", "done")
    assert not [truth for truth in run.truth if truth.touched]
