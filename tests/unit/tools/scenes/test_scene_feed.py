"""Markers and transforms of a run: bounded, in one tree of frames, at a modest rate, and true."""

import json
import math
from dataclasses import replace

import pytest

from tailor.robots import arm_scene
from tailor.schemas import messages as m
from tailor.schemas.codec import encode
from tailor.schemas.errors import UsageError
from tailor.schemas.messages.soccer import BallTruth, Opponent, OpponentsTruth, SoccerGroundTruth
from tailor.schemas.packages.pose3 import Pose3, on_plane
from tailor.schemas.packages.scene import MAP, Scene, frame, line, on_map, pose_of, sphere
from tailor.schemas.topics import TOPICS
from tailor.simnodes.powercube.body import PowerCubeBody
from tailor.tools.scenes import robot_scenes
from tailor.tools.scenes.robot_scenes import RobotScenes
from tailor.tools.scenes.scene_feed import MAX_POINTS, MAX_SHAPES, SceneFeed, bounded
from tests.support import synthetic_run

BELIEF = (1.0, 0.5, 0.3, 0.4, 0.0, 2.0, 0.1, 0.01, 0.02)


def published(feed, *timed):
    return [each for at_s, key, message in timed for each in feed.messages_after(at_s, key, message)]


def soccer_feed() -> SceneFeed:
    feed = SceneFeed()
    order = json.dumps(synthetic_run.order("soccer", 0))
    assert published(feed, (0.0, "exec/provenance", m.Provenance(0, order))) == []
    assert published(feed, (0.0, "agilo/odom", m.Odometry(0, 0.0, 0.0, 0.0, 0.0, 0.0))) == []
    return feed


def status(belief=BELIEF, action="goToPose", index=0, stamp_ns=5):
    return synthetic_run.status(stamp_ns, "EXECUTING", "", action, index, 0.1, 1.0, belief)


def test_nothing_is_published_before_the_executive_names_its_domain():
    assert published(SceneFeed(), (0.0, "exec/status", status())) == []


def test_map_odom_and_base_link_are_one_chain_that_leads_to_the_believed_pose():
    feed = soccer_feed()
    odometry = m.Odometry(0, -3.0, 7.0, 2.0, 0.4, 0.0)
    frames = dict(published(feed, (0.1, "agilo/odom", odometry), (0.1, "exec/status", status())))["transforms"]
    assert [(each.parent, each.child) for each in frames.transforms] == [("map", "odom"), ("odom", "base_link")]
    base = on_map(frames.transforms)["base_link"]
    assert (base.x, base.y, base.yaw) == pytest.approx((1.0, 0.5, 0.3))
    assert pose_of(frames.transforms[1]).yaw == pytest.approx(2.0)
    assert frames.stamp_ns == 5


def test_scenes_go_on_after_a_clock_that_was_set_back():
    feed = soccer_feed()
    names = [{name for name, _ in published(feed, (at_s, "exec/status", status()))} for at_s in (100.0, 100.01, 40.0)]
    assert [{"scene", "transforms"} <= each for each in names] == [True, False, True]


def test_a_robot_with_odometry_is_drawn_once_it_has_come():
    feed = SceneFeed("soccer")
    assert {name for name, _ in published(feed, (0.1, "exec/status", status()))} == {"log"}


def test_a_robot_without_odometry_stands_in_map():
    belief = (0.1, 0.0, 0.2, 0.0)
    frames = dict(published(SceneFeed("arm"), (0.1, "exec/status", status(belief, "reach"))))["transforms"]
    chain = [(each.parent, each.child) for each in frames.transforms]
    assert chain[0] == ("map", "base_link")
    assert chain[-1][1] == "pen"
    assert [parent for parent, _ in chain[1:]] == [child for _, child in chain[:-1]]


def test_shapes_have_unique_names_and_frames_that_the_transforms_lead_to():
    messages = dict(published(soccer_feed(), (0.1, "exec/status", status())))
    shapes = messages["scene"].shapes
    assert len({shape.name for shape in shapes}) == len(shapes)
    assert {shape.frame for shape in shapes} <= set(on_map(messages["transforms"].transforms))
    assert {"ball", "chassis", "field", "doing"} <= {shape.name for shape in shapes}


def test_rates_are_five_and_ten_hertz():
    feed = soccer_feed()
    names = [
        name for k in range(100) for name, _ in published(feed, (k / 10 + 0.01 * (k % 2), "exec/status", status()))
    ]
    assert 95 <= names.count("transforms") <= 100
    assert 45 <= names.count("scene") <= 52


def test_the_truth_is_drawn_in_map_with_all_that_the_simulator_publishes():
    feed = soccer_feed()
    opponents = OpponentsTruth(0, False, (Opponent(1.0, 2.0, 0.2),))
    truth = SoccerGroundTruth(0, 1.0, 0.5, math.pi / 2, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0)
    others = (0.1, "agilo/sim/opponents", opponents), (0.1, "agilo/sim/ball2", BallTruth(0, -1.5, 0.0, 0.0, 0.0))
    made = published(feed, *others, (0.1, "agilo/sim/truth", truth))
    [(topic, scene)] = made
    assert topic == "scene_truth"
    assert {shape.frame for shape in scene.shapes} == {MAP}
    by_name = {shape.name: shape for shape in scene.shapes}
    assert [by_name[name].x for name in ("opponent 1", "ball", "second ball")] == [1.0, 2.0, -1.5]
    chassis = by_name["chassis"]
    assert (chassis.x, chassis.y) == pytest.approx((1.0, 0.5 - 0.025)), "2.5 cm behind the axle, looking along y"


def test_other_robots_are_not_drawn():
    truth = SoccerGroundTruth(0, *[0.0] * 9)
    assert published(soccer_feed(), (0.1, "b21/sim/truth", truth)) == []


def test_subgoals_are_arrows_green_where_they_are_free():
    feed = soccer_feed()
    goal = [m.Parameter(f"{q}g", i, "pos2", "m", q != "phi", 0.0, 1.0, v) for i, (q, v) in enumerate(GOAL.items())]
    start = [m.Parameter(q, 9 + i, "pos1", "m", True, 0.0, 1.0, 0.0) for i, q in enumerate(GOAL)]
    action = m.InstantiatedAction("goToPose", 1, False, 2.0, 0.1, (*start, *goal))
    made = published(feed, (0.0, "exec/subgoals", m.Subgoals(0, 1, 2, (action,))), (0.1, "exec/status", status()))
    arrow = next(shape for shape in dict(made)["scene"].shapes if shape.name == "subgoal pos2")
    assert (arrow.x, arrow.y, pose_of(arrow).yaw) == pytest.approx((2.0, -1.0, 0.7))
    assert arrow.green > arrow.red
    assert not any("pos1" in shape.name for shape in dict(made)["scene"].shapes), "it is where the robot starts"


GOAL = {"x": 2.0, "y": -1.0, "phi": 0.7, "v": 0.3}


def test_the_way_begins_anew_with_a_new_task():
    feed = soccer_feed()
    ways = []
    for k, index in enumerate([0] * 10 + [1] * 10 + [0] * 3):
        belief = (0.1 * k, *BELIEF[1:])
        made = dict(published(feed, (0.3 * k, "exec/status", status(belief, index=index))))
        ways.append([len(shape.points) // 3 for shape in made["scene"].shapes if shape.name == "way"])
    assert ways[9] == [10]
    assert ways[19] == [20], "another action of the same task"
    assert ways[-1] == [3]


def test_the_pen_is_where_the_simulated_arm_has_it():
    body = PowerCubeBody()
    body.reset(NO_DRAW, {"a": 0.5, "b": 0.3})
    body.advance(10_000_000)
    truth = body.ground_truth()
    drawn = on_map(arm_scene.of_truth(truth).frames)["pen"]
    assert (drawn.x, drawn.y, drawn.z) == pytest.approx(body.pen_m(), abs=2e-3)
    goal = arm_scene.of_subgoal({"a": truth.positions[0], "b": truth.positions[1]})
    assert (goal.x, goal.y, goal.z) == pytest.approx(body.pen_m(), abs=2e-3)


class _NoDraw:
    """A generator whose noise is none."""

    def standard_normal(self, size=None):
        import numpy as np

        return 0.0 if size is None else np.zeros(size)

    def uniform(self, low=0.0, high=1.0, size=None):
        return (low + high) / 2


NO_DRAW = _NoDraw()


def test_a_scene_however_large_fits_into_its_topic():
    many = tuple(sphere("name " * 100, 0.1) for _ in range(1000))
    long = line("long", [(float(k), 0.0, 0.0) for k in range(10_000)])
    kept = bounded((long, long, *many))
    assert len(kept) == MAX_SHAPES
    assert sum(len(shape.points) for shape in kept) == 3 * MAX_POINTS
    assert len(encode(m.SceneShapes(0, kept))) <= TOPICS["scene"].max_bytes


def test_a_package_that_fails_to_draw_is_reported_and_stops_nothing(monkeypatch):
    from tailor.robots import soccer_scene

    monkeypatch.setattr(soccer_scene, "of_belief", lambda values: values["wings"])
    feed = soccer_feed()
    assert {name for name, _ in published(feed, (0.1, "exec/status", status()))} == {"log"}
    assert feed.fault == "of_belief: KeyError: 'wings'"


DRAWN = Scene((frame("base_link", Pose3()),), (sphere("ball", 0.1),))
WRONG_SCENES = {
    "None, expected a Scene ": None,
    "'x', expected a Scene ": "x",
    "Scene(frames=(3,), shapes=(), ": replace(DRAWN, frames=(3,), shapes=()),
    "Scene(frames=(), shapes=(None,), ": replace(DRAWN, frames=(), shapes=(None,)),
    "Scene(frames=(), shapes=None, ": replace(DRAWN, frames=(), shapes=None),
    "Scene(frames=(), shapes=(), tracer='base": replace(DRAWN, frames=(), shapes=(), speed_mps=None),
}


@pytest.mark.parametrize("fault", WRONG_SCENES)
def test_what_cannot_be_drawn_is_reported_and_stops_nothing(monkeypatch, fault):
    from tailor.robots import soccer_scene

    monkeypatch.setattr(soccer_scene, "of_belief", lambda values: WRONG_SCENES[fault])
    feed = soccer_feed()
    assert {name for name, _ in published(feed, (0.1, "exec/status", status()))} == {"log"}
    assert feed.fault.startswith(f"of_belief returned {fault}")
    assert feed.fault.endswith("(schemas/packages/scene.py)")
    monkeypatch.setattr(soccer_scene, "of_belief", lambda values: DRAWN)
    assert "scene" in {name for name, _ in published(soccer_feed(), (0.1, "exec/status", status()))}


def test_a_subgoals_place_that_is_none_is_reported(monkeypatch):
    from tailor.robots import soccer_scene

    monkeypatch.setattr(soccer_scene, "of_subgoal", lambda values: 3)
    scenes = RobotScenes("soccer")
    parameters = tuple(m.Parameter(name, 1, "pos1", "m", True, 0.0, 0.0, 0.0) for name in ("x", "xg"))
    action = m.InstantiatedAction("goToPose", 1, False, 1.0, 0.0, (replace(parameters[0], label="pos0"), parameters[1]))
    assert scenes.of_subgoals(m.Subgoals(0, 1, 1, (action,))) == ()
    assert scenes.fault == "of_subgoal returned 3, expected a Pose3 or None (schemas/packages/scene.py)"


def test_a_package_whose_scene_cannot_be_imported_is_drawn_by_convention(monkeypatch):
    def broken(spec, field):
        raise UsageError(f"domain {spec.name}: {field}: NameError")

    monkeypatch.setattr(robot_scenes, "part", broken)
    scenes = RobotScenes("soccer")
    assert scenes.fault == "domain soccer: scene: NameError"
    assert scenes.of_belief(BELIEF) is not None


def test_scenes_of_a_robot_without_one_are_drawn_by_convention():
    scenes = RobotScenes("no-such-domain")
    scene = scenes.of_truth(m.PlanarTruth(0, 1.0, 2.0, 0.5, 0.3, 0.0))
    assert scene == Scene((frame("base_link", on_plane(1.0, 2.0, 0.5)),), scene.shapes, "base_link", 0.3)
    assert scenes.of_truth(m.JointState(0, ("a",), (0.1,), (0.0,), (0.0,))) is None
    assert on_map(scene.frames)["map"] == Pose3()


def test_the_log_has_a_line_for_each_change_and_none_for_a_repetition():
    feed = soccer_feed()
    done = m.ActionFinished(7, 1, "goToPose", 0, "done", "", 1.0, 1.2)
    stopped = m.DriverState(8, "stopped", "no valid command in time", "", 7, "", 0)
    run = (
        (0.1, "exec/status", status()),
        (0.2, "exec/status", status()),
        (0.3, "exec/finished", done),
        (0.4, "exec/status", status(index=1)),
        (0.5, "agilo/driver", stopped),
        (0.6, "agilo/driver", stopped),
    )
    lines = [message for name, message in published(feed, *run) if name == "log"]
    begins = "goToPose begins, predicted 1.00 s"
    assert [line.text for line in lines[:3]] == ["EXECUTING", begins, "goToPose done after 1.20 s"]
    assert lines[3].text == begins, "another action of the same name"
    assert (lines[4].level, lines[4].stamp_ns, len(lines)) == (m.WARNING, 8, 5)


def test_the_way_begins_anew_with_the_first_action_after_a_restart_of_the_driver():
    feed = soccer_feed()

    def way(at_s, x, action):
        scene = dict(published(feed, (at_s, "exec/status", status((x, *BELIEF[1:]), action))))["scene"]
        return [shape.points[::3] for shape in scene.shapes if shape.name == "way"]

    def driver(epoch):
        assert published(feed, (0.0, "agilo/driver", m.DriverState(0, "disarmed", "", "", epoch, "", 0))) is not None

    driver(1)
    assert [len(way(at_s, at_s, "goToPose")) for at_s in (1.0, 2.0)] == [0, 1]
    driver(2)
    assert [way(at_s, x, "") for at_s, x in ((3.0, 2.0), (4.0, 30.0))] == [[], []]  # the belief follows
    assert [way(at_s, x, "goToPose") for at_s, x in ((5.0, 30.0), (6.0, 31.0))] == [[], [pytest.approx((30.0, 31.0))]]
