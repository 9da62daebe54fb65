"""Drives know whether the stool has been seen: it is bound from the belief, at every place and subgoal."""

from __future__ import annotations

import pytest

from tailor.executive import domains, planning
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.kitchen.belief import KitchenBelief
from tailor.executive.domains.kitchen.objects import Thing
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.refinement.assertion.asserted_subgoal import with_subgoal
from tailor.executive.refinement.instantiation import instantiate

STOOL = Thing("stool", 1.2, 0.5, 0.22, 0.0, 0.0, 1e-6, 1)


def drives_of(things):
    """The plan for a cup, with a subgoal before its first drive; all drives by the values of their parameters."""
    domain = domains.load("kitchen")
    task, _ = domains.seeded_scenario("kitchen", "one-cup", 3)
    pddl = planning.parse_domain(domain.pddl)
    search = planning.Search(pddl, planning.parse_problem(task.problem, pddl), planning.DEFAULT)
    plan = search.advance(CheckBudget(100_000)).plan
    pose = Pose(0.0, 0.6, 0.0, (1e-8, 0.0, 0.0, 1e-8, 0.0, 1e-8))
    belief = KitchenBelief(pose=pose, things=things, poses_seen=9, joints_ns=1)
    sequence = with_subgoal(instantiate(plan, domain, belief, task), 0)
    drives = [each for each in sequence.actions if each.action.name == "goToPose"]
    return [
        {p.name: sequence.variables[i].value for p, i in zip(each.action.parameters, each.variables, strict=True)}
        for each in drives
    ]


@pytest.mark.parametrize(("things", "seen"), [((), 0.0), ((STOOL,), 1.0)])
def test_every_drive_and_the_one_to_a_subgoal_know_whether_the_stool_has_been_seen(things, seen):
    drives = drives_of(things)
    assert [drive["seen"] for drive in drives] == [seen] * 3
    assert drives[1]["x"] is None, "after the subgoal it starts from there"
