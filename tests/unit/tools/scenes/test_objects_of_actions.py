"""Objects that actions take into account are drawn in the believed scene, although no belief value names them."""

from __future__ import annotations

import json

import pytest

from tailor.executive import domains
from tailor.schemas import messages as m
from tailor.schemas.packages.scene import pose_of
from tailor.tools.scenes.robot_scenes import RobotScenes
from tailor.tools.viewer.timeline import RunTimeline
from tests.support import synthetic_run

COLUMNS = ("box_x", "box_y", "box_phi", "box_long", "box_wide", "box_r", "box_high")
ROWS = (0.5, -0.3, 0.0, 0.0, 0.0, 0.17, 0.45, 1.1, 1.95, 0.0, 0.3, 0.3, 0.0, 1.7)  # the stool, the fridge
STOOL = m.Contexts(0, 1, (m.ActionObjects("goToPose", COLUMNS, ROWS),))
STAND = {"x": 1.3, "y": -0.5, "phi": 0.1, "spot_x": 2.1, "spot_y": -0.4}


def beliefs():
    kitchen = domains.load("kitchen")
    return kitchen.belief_values(kitchen.initial_belief())


def stools(scene):
    return [(pose_of(shape).x, pose_of(shape).y) for shape in scene.shapes if shape.name == "stool"]


def test_the_stool_is_drawn_where_a_drive_takes_it_into_account():
    scenes = RobotScenes("kitchen")
    assert stools(scenes.of_belief(beliefs())) == []
    scenes.note(STOOL)
    assert stools(scenes.of_belief(beliefs())) == [(0.5, -0.3)]
    two_drives = m.Contexts(0, 2, STOOL.contexts * 2)
    scenes.note(two_drives)
    assert stools(scenes.of_belief(beliefs())) == [(0.5, -0.3)], "once, however many actions pass it"
    assert scenes.fault == ""


def test_a_robot_that_draws_no_objects_ignores_them():
    scenes = RobotScenes("soccer")
    soccer = domains.load("soccer")
    values = soccer.belief_values(soccer.initial_belief())
    before = scenes.of_belief(values)
    scenes.note(STOOL)
    assert scenes.of_belief(values) == before
    assert scenes.fault == ""


def test_the_page_draws_the_stool_a_stand_and_its_spot():
    timeline = RunTimeline()
    parameters = tuple(m.Parameter(q, k, "table2", "m", False, 0.0, 3.0, v) for k, (q, v) in enumerate(STAND.items()))
    start = m.Parameter("x", 9, "dock", "m", True, 0.0, 0.0, 0.0)
    drive = m.InstantiatedAction("goToPose", 1, False, 5.0, 0.1, (start, *parameters[:3]))
    put = m.InstantiatedAction("put", 2, False, 8.0, 0.1, parameters)
    status = synthetic_run.status(0, "EXECUTING", "", "goToPose", 0, 0.1, 1.0, beliefs())
    messages = {
        "exec/provenance": m.Provenance(0, json.dumps(synthetic_run.order("kitchen", 0))),
        "exec/contexts": STOOL,
        "exec/subgoals": m.Subgoals(0, 1, 2, (drive, put)),
        "exec/status": status,
    }
    found = {e.kind: e.fields for key, message in messages.items() for e in timeline.events_of(0.1, key, message)}
    assert found["subgoals"]["places"]["table2"] == pytest.approx([STAND["x"], STAND["y"]])
    assert found["subgoals"]["targets"]["table2"] == pytest.approx([STAND["spot_x"], STAND["spot_y"]])
    assert found["believed"]["places"]["stool"][:2] == pytest.approx([0.5, -0.3])
    assert found["outline believed stool"]["closed"]
