"""The page is told everything once, nothing too often, and nothing that JSON or the page cannot take."""

from __future__ import annotations

import json
import math

import pytest

from tailor.schemas import messages as m
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.schemas.own import example
from tailor.schemas.typesystem import MESSAGES
from tailor.tools.viewer.event_fields import numbers
from tailor.tools.viewer.timeline import Event, RunTimeline
from tests.support import synthetic_run


def rows_of(run) -> list[Event]:
    story = RunTimeline()
    return [row for t in run for row in story.tell(t.time_ns / 1e9, t.key, t.message)]


def kinds(rows) -> set[str]:
    return {row.kind for row in rows}


@pytest.mark.parametrize("kind", MESSAGES, ids=lambda kind: kind.__name__)
def test_every_message_of_the_bus_can_be_told_as_json(kind: type) -> None:
    rows = RunTimeline().tell(0.0, "agilo/anything", example(kind))
    assert json.loads(json.dumps([row.json_value() for row in rows], allow_nan=False)) is not None


def test_a_soccer_run_tells_path_actions_plan_subgoals_and_ticks() -> None:
    rows = rows_of(synthetic_run.soccer_run())
    assert {"truth", "believed", "action", "finished", "plan", "subgoals", "refinement", "tick", "about"} <= kinds(rows)
    assert [row.fields["action"] for row in rows if row.kind == "finished"] == ["approachBall", "dribbleBall"]


def test_an_arm_is_told_as_belief_values_and_never_as_a_point_on_the_plane() -> None:
    rows = rows_of(synthetic_run.arm_run())
    assert not kinds(rows) & {"truth", "believed", "seen", "odom"}
    assert len(next(row for row in rows if row.kind == "belief").fields["values"]) == 4


def test_what_does_not_change_is_told_once() -> None:
    story = RunTimeline()
    state = m.DriverState(0, "armed", "", "", 7, "", 0)
    assert len(story.tell(0.0, "agilo/driver", state)) == 1
    assert story.tell(1.0, "agilo/driver", state) == []
    stopped = m.DriverState(0, "stopped", "no valid command in time", "", 7, "", 0)
    assert len(story.tell(2.0, "agilo/driver", stopped)) == 1


def test_fast_sensors_are_thinned_out_and_ten_hertz_come_through_with_jitter() -> None:
    story = RunTimeline()
    fast = [story.tell(k / 50, "agilo/odom", m.Odometry(0, k, 0, 0, 0, 0)) for k in range(100)]
    assert 20 <= sum(map(len, fast)) <= 34
    jitter = [0.0, 0.113, 0.19, 0.31, 0.387, 0.5]
    assert all(story.tell(9 + at, "agilo/sim/truth", SoccerGroundTruth(0, *[0.0] * 9)) for at in jitter)


def test_topics_that_the_page_does_not_know_are_told_as_named_numbers() -> None:
    joints = m.JointState(0, ("elbow", "wrist"), (0.25, 1.5), (0.0, 0.1), ())
    (row,) = RunTimeline().tell(0.0, "powercube/joint_states", joints)
    assert row.kind == "series joint_states"
    assert row.fields == {
        "positions elbow": 0.25,
        "positions wrist": 1.5,
        "velocities elbow": 0.0,
        "velocities wrist": 0.1,
    }


def test_only_the_executives_robot_is_told_of_once_it_is_known() -> None:
    story = RunTimeline(robot="agilo")
    pose = m.Odometry(0, 1.0, 2.0, 0.0, 0.0, 0.0)
    assert story.tell(0.0, "b21/odom", pose) == []
    assert len(story.tell(0.0, "agilo/odom", pose)) == 1
    assert len(story.tell(0.0, "estop", m.EStop(True))) == 1


def test_a_ball_that_was_never_seen_is_not_drawn() -> None:
    names = ("x (m)", "y (m)", "phi (rad)", "v (m/s)", "ball_x (m)", "ball_y (m)", "ball_sigma (m)")
    from tailor.tools.viewer.event_fields import believed

    assert "ball" not in believed(names, (0, 0, 0, 0, 0, 0, -1))
    assert believed(names, (0, 0, 0, 0, 1, 2, 0.1))["ball"] == [1, 2]
    assert believed(("a (rad)", "b (rad)"), (0.1, 0.2)) is None


def test_numbers_that_are_not_finite_become_null() -> None:
    assert numbers(m.VelocityCommand(0, math.nan, math.inf)) == {"v": None, "omega": None}


def test_a_plan_tells_links_and_orderings_apart() -> None:
    (row,) = RunTimeline().tell(0.0, "exec/plan", m.PlanReport(0, "solved", "searched", TWO_BALLS, 5, 4, ""))
    assert {"from": 2, "literal": "(atball pos2)", "to": 1} in row.fields["links"]
    assert {"from": 0, "literal": "(final pos3)", "to": "goal"} in row.fields["links"]
    assert row.fields["orderings"] == [[1, 3]], "2<1 has a link, 2<3 follows from the others"


def test_a_plan_that_cannot_be_read_is_told_with_the_reason() -> None:
    (row,) = RunTimeline().tell(0.0, "exec/plan", m.PlanReport(0, "solved", "searched", "gibberish", 5, 4, ""))
    assert row.fields["text"] == "gibberish"
    assert "line 1" in row.fields["reason"]


TWO_BALLS = """;two
Initial  : (robot pos1) (ball pos2) (final pos3)

Step 2   : (approachball pos1 pos2)
          0   -> (robot pos1)

Step 1   : (dribbleball pos2 pos3)
          2   -> (atball pos2)

Step 3   : (park pos3)

Goal     :
          0   -> (final pos3)
          1   -> (atball pos3)
orderings = { 2<1 1<3 2<3 }
"""
