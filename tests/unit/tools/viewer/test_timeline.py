"""The timeline sends states once, samples at a limited rate, and only values that JSON and the page can read."""

from __future__ import annotations

import json
import math

import pytest

from tailor.schemas import messages as m
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.schemas.own import example
from tailor.schemas.typesystem import message_types
from tailor.tools.scenes import planar_convention
from tailor.tools.viewer.event_fields import numbers
from tailor.tools.viewer.timeline import Event, RunTimeline
from tests.support import synthetic_run


def events_of(run) -> list[Event]:
    timeline = RunTimeline()
    return [event for t in run for event in timeline.events_of(t.time_ns / 1e9, t.key, t.message)]


def kinds(events) -> set[str]:
    return {event.kind for event in events}


@pytest.mark.parametrize("kind", message_types(), ids=lambda kind: kind.__name__)
def test_every_message_of_the_bus_has_events_in_json(kind: type) -> None:
    events = RunTimeline().events_of(0.0, "agilo/anything", example(kind))
    assert json.loads(json.dumps([event.json_value() for event in events], allow_nan=False)) is not None


def test_a_soccer_run_has_path_actions_plan_subgoals_and_ticks() -> None:
    events = events_of(synthetic_run.soccer_run())
    assert {"truth", "believed", "action", "finished", "plan", "subgoals", "refinement", "tick", "about"} <= kinds(
        events
    )
    assert [event.fields["action"] for event in events if event.kind == "finished"] == ["approachBall", "dribbleBall"]


def test_a_robot_of_which_nothing_is_known_has_belief_values_and_never_a_pose() -> None:
    events = events_of(synthetic_run.arm_run())
    assert not kinds(events) & {"truth", "believed", "seen", "odom"}
    assert len(next(event for event in events if event.kind == "belief").fields["values"]) == 4


def test_an_arm_has_a_pen_without_a_heading_and_links_that_turn() -> None:
    timeline = RunTimeline()
    timeline.events_of(0.0, "exec/provenance", m.Provenance(0, json.dumps(synthetic_run.order("arm", 0))))
    first, second = (
        [event for event in timeline.events_of(at_s, "exec/status", arm_status(lift)) if event.kind != "state"]
        for at_s, lift in ((0.1, 0.0), (0.2, 0.4))
    )
    drawn = next(event for event in second if event.kind == "believed")
    assert drawn.fields["phi"] is None
    assert "lift link" in drawn.fields["places"]
    assert "outline believed lift link" in kinds(first) & kinds(second), "seen from behind its outline changes"
    assert "outline believed column" in kinds(first) - kinds(second), "what does not change is sent once"


def test_a_simulator_is_drawn_as_its_robot_before_the_executive_is_up() -> None:
    events = RunTimeline().events_of(0.0, "agilo/sim/truth", SoccerGroundTruth(0, *[0.0] * 9))
    assert "outline truth chassis" in kinds(events)
    stranger = RunTimeline().events_of(0.0, "rover/sim/pose", m.PlanarTruth(0, *[0.0] * 5))
    assert "outline truth robot" in kinds(stranger), "by convention"


def arm_status(lift: float) -> m.ExecStatus:
    return synthetic_run.status(0, "EXECUTING", "", "reach", 0, 0.1, 1.0, (0.3, 0.0, lift, 0.0))


def test_an_unchanged_state_is_sent_once() -> None:
    timeline = RunTimeline()
    state = m.DriverState(0, "armed", "", "", 7, "", 0)
    assert len(timeline.events_of(0.0, "agilo/driver", state)) == 1
    assert timeline.events_of(1.0, "agilo/driver", state) == []
    stopped = m.DriverState(0, "stopped", "no valid command in time", "", 7, "", 0)
    assert len(timeline.events_of(2.0, "agilo/driver", stopped)) == 1


def test_a_report_that_comes_again_is_shown_once() -> None:
    """600 000 of them fit into 10 kB of a recording."""
    timeline = RunTimeline()
    twice = [timeline.events_of(at_s, "exec/subgoals", m.Subgoals(7, 5, 2, ())) for at_s in (0.1, 0.2)]
    assert [kinds(events) for events in twice] == [{"subgoals"}, set()]
    assert kinds(timeline.events_of(0.3, "exec/subgoals", m.Subgoals(8, 5, 2, ()))) == {"subgoals"}


def test_fast_sensors_are_thinned_out_and_ten_hertz_come_through_with_jitter() -> None:
    timeline = RunTimeline()
    fast = [timeline.events_of(k / 50, "agilo/odom", m.Odometry(0, k, 0, 0, 0, 0)) for k in range(100)]
    assert 20 <= sum(map(len, fast)) <= 34
    jitter = [0.0, 0.113, 0.19, 0.31, 0.387, 0.5]
    assert all(timeline.events_of(9 + at, "agilo/sim/truth", SoccerGroundTruth(0, *[0.0] * 9)) for at in jitter)


def test_samples_go_on_after_a_clock_that_was_set_back() -> None:
    timeline = RunTimeline()
    shown = [timeline.events_of(at_s, "agilo/odom", m.Odometry(0, 1, 0, 0, 0, 0)) for at_s in (100.0, 40.0, 40.1)]
    assert [[event.at_s for event in events] for events in shown] == [[100.0], [40.0], [40.1]]


def test_topics_unknown_to_the_page_become_named_numbers() -> None:
    joints = m.JointState(0, ("elbow", "wrist"), (0.25, 1.5), (0.0, 0.1), ())
    (event,) = RunTimeline().events_of(0.0, "powercube/joint_states", joints)
    assert event.kind == "series joint_states"
    assert event.fields == {
        "positions elbow": 0.25,
        "positions wrist": 1.5,
        "velocities elbow": 0.0,
        "velocities wrist": 0.1,
    }


def test_only_the_executives_robot_is_shown_once_it_is_known() -> None:
    timeline = RunTimeline(robot="agilo")
    pose = m.Odometry(0, 1.0, 2.0, 0.0, 0.0, 0.0)
    assert timeline.events_of(0.0, "b21/odom", pose) == []
    assert len(timeline.events_of(0.0, "agilo/odom", pose)) == 1
    assert len(timeline.events_of(0.0, "estop", m.EStop(True))) == 1


def test_an_object_that_was_never_observed_is_not_drawn() -> None:
    names = ("x", "y", "phi", "v", "ball_x", "ball_y", "ball_sigma")

    def drawn(*values: float) -> set[str]:
        return {shape.name for shape in planar_convention.of_belief(dict(zip(names, values, strict=True))).shapes}

    assert "ball" not in drawn(0, 0, 0, 0, 0, 0, -1)
    assert "ball" in drawn(0, 0, 0, 0, 1, 2, 0.1)
    assert "ball" not in drawn(0, 0, 0, 0, 99, 2, 0.1), "too far: a scenario without a ball"
    assert planar_convention.of_belief({"a": 0.1, "b": 0.2}).frames == ()


def test_numbers_that_are_not_finite_become_null() -> None:
    assert numbers(m.VelocityCommand(0, math.nan, math.inf)) == {"v": None, "omega": None}


def test_a_plan_separates_links_and_orderings() -> None:
    (event,) = RunTimeline().events_of(0.0, "exec/plan", m.PlanReport(0, "solved", "searched", TWO_BALLS, 5, 4, ""))
    assert {"from": 2, "literal": "(atball pos2)", "to": 1} in event.fields["links"]
    assert {"from": 0, "literal": "(final pos3)", "to": "goal"} in event.fields["links"]
    assert event.fields["orderings"] == [[1, 3]], "2<1 has a link, 2<3 follows from the others"


def test_an_invalid_plan_is_sent_with_the_reason() -> None:
    (event,) = RunTimeline().events_of(0.0, "exec/plan", m.PlanReport(0, "solved", "searched", "gibberish", 5, 4, ""))
    assert event.fields["text"] == "gibberish"
    assert "line 1" in event.fields["reason"]


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


@pytest.mark.parametrize("value", [math.nan, math.inf, [math.nan], {"a": math.nan}])
@pytest.mark.parametrize("path", [("scenario",), ("domain",), ("settings", "seed"), ("settings", "refinement")])
def test_a_page_can_carry_the_facts_of_any_provenance(path: tuple[str, ...], value: object) -> None:
    """Python reads NaN from JSON, and no page does: a stranger's message would end the page of all."""
    config = {"horizon": value} if path[-1] == "refinement" else value
    for name in reversed(path):
        config = {name: config}
    [event] = RunTimeline().events_of(0.0, "exec/provenance", m.Provenance(0, json.dumps({"config": config})))
    json.dumps(event.json_value(), allow_nan=False)


def test_a_restart_of_the_driver_is_an_event_once() -> None:
    timeline = RunTimeline()
    states = [m.DriverState(0, "disarmed", "", "", epoch, "", 0) for epoch in (7, 7, 8, 8, 7, 8)]
    events = [timeline.events_of(0.1 * k, "agilo/driver", state) for k, state in enumerate(states)]
    assert ["restart" in kinds(each) for each in events] == [False, False, True, False, False, False]


def test_drivers_of_two_robots_are_no_restart() -> None:
    timeline = RunTimeline()
    for epoch, key in enumerate(("agilo/driver", "b21/driver")):
        assert "restart" not in kinds(timeline.events_of(0.0, key, m.DriverState(0, "disarmed", "", "", epoch, "", 0)))
