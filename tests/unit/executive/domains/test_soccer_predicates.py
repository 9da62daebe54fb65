"""Soccer's predicates: values from the belief, ranges for what is to be achieved, facts from percepts."""

import dataclasses
import math

import numpy as np
import pytest

from tailor.executive import domains
from tailor.executive.belief.ball_track import BallTrack
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.soccer import belief as believing
from tailor.executive.domains.soccer import robot
from tailor.executive.interfaces.domain import Conflict, LabelQuery, Scenario
from tailor.executive.interfaces.domain_results import relocations
from tailor.executive.interfaces.values import Interval
from tailor.schemas.messages import Odometry, PoseEstimate, Sample
from tailor.schemas.messages.soccer import BallPercept
from tailor.tools.lockstep.action_run import new_body
from tailor.tools.lockstep.readings import newest

SOCCER = domains.load("soccer")
PLACES = {"pos3": {"x": 1.0, "y": 3.0, "phi": 2.6, "v": 0.0}}
LABELS = {"robot_label": "pos1", "ball_label": "pos2", "target_label": "pos3"}
SCENARIO = Scenario("approach-dribble", "", PLACES, LABELS)
COVARIANCE = (1e-4, 0.0, 0.0, 1e-4, 0.0, 1e-4)


def believe(x=0.0, y=1.0, phi=0.0, v=0.0, ball=(3.0, 0.0)):
    track = BallTrack(*ball, 0.0, 0.0, 1e-4, 0) if ball else None
    return dataclasses.replace(believing.unknown(), pose=Pose(x, y, phi, COVARIANCE), v=v, ball=track, poses_seen=99)


def value(quantity, label, holds=(), achieved=(), belief=None, scenario=SCENARIO):
    return SOCCER.value(LabelQuery(quantity, label, holds, achieved, belief or believe(), scenario))


def test_example_of_the_paper_gets_its_values():
    """Below line 14 of Algorithm 2: robot at (0, 1, 0, 0), ball at (3, 1), target (1, 3, 2.6, 0)."""
    start = [value(q, "pos1", (("robot", "pos1"),)) for q in ("x", "y", "phi", "v")]
    assert start == [Interval(0.0, 0.0), Interval(1.0, 1.0), Interval(0.0, 0.0), Interval(0.0, 0.0)]
    middle = [value(q, "pos2", (("ball", "pos2"),), (("atball", "pos2"),)) for q in ("x", "y", "phi", "v")]
    assert middle == [Interval(3.0, 3.0), Interval(1.0, 1.0), None, Interval(0.0, 0.3)]
    end = [value(q, "pos3", (("final", "pos3"),), (("atball", "pos3"),)) for q in ("x", "y", "phi", "v")]
    assert end == [Interval(1.0, 1.0), Interval(3.0, 3.0), Interval(2.6, 2.6), Interval(0.0, 0.0)]


def test_robot_that_has_the_ball_is_where_it_is_heading_as_it_does():
    belief = believe(phi=0.5, v=0.2, ball=(0.33, 0.0))
    holds = (("atball", "pos2"),)
    assert value("phi", "pos2", holds, (), belief) == Interval(0.5, 0.5)
    assert value("v", "pos2", holds, (), belief) == Interval(0.2, 0.2)
    assert value("x", "pos2", holds, (), belief).lower == pytest.approx(0.33 * math.cos(0.5))


@pytest.mark.parametrize("achieved", [(("ball", "pos3"),), (("atball", "pos3"),)])
def test_a_ball_brought_to_the_target_is_at_its_place_though_the_goal_does_not_name_it_final(achieved):
    assert [value(q, "pos3", (), achieved) for q in ("x", "y")] == [Interval(1.0, 1.0), Interval(3.0, 3.0)]
    assert value("phi", "pos3", (), achieved) is None
    assert value("x", "pos4", (), achieved) is None, "no target"


def test_waypoint_is_at_its_place_of_the_scenario_and_its_heading_is_free():
    scenario = Scenario("waypoints", "", {"way1": {"x": 2.0, "y": -1.0}})
    holds = (("route", "home", "way1"),)
    assert value("x", "way1", holds, (("robot", "way1"),), None, scenario) == Interval(2.0, 2.0)
    assert value("phi", "way1", holds, (("robot", "way1"),), None, scenario) is None
    assert value("x", "home", (*holds, ("robot", "home")), (), None, scenario) == Interval(0.0, 0.0)


def test_predicates_that_exclude_each_other_are_a_conflict_that_names_the_quantity():
    with pytest.raises(Conflict, match="x of pos3"):
        value("x", "pos3", (("final", "pos3"), ("ball", "pos3")))


def test_ball_that_was_never_seen_has_no_place():
    with pytest.raises(Conflict, match="not been seen"):
        value("x", "pos2", (("ball", "pos2"),), (), believe(ball=None))


APART = {("robot", "pos1"), ("ball", "pos2")}
FINAL = ("final", "pos3")


@pytest.mark.parametrize(
    ("belief", "expected"),
    [
        (believe(), APART),
        (believe(ball=(0.36, 0.05)), {("robot", "pos2"), ("ball", "pos2"), ("atball", "pos2")}),
        (believe(ball=(0.36, 0.40)), APART),
        (believe(ball=(0.9, 0.0)), APART),
        (believe(x=0.7, y=3.0, ball=(0.32, 0.0)), {("robot", "pos3"), ("ball", "pos3"), ("atball", "pos3")}),
        (believe(x=-2.0, y=3.0, ball=(3.0, 0.0)), APART),  # at the target, but not had
    ],
)
def test_abstract_state_is_read_off_the_belief(belief, expected):
    remembered = frozenset({("robot", "pos2"), ("ball", "pos2"), ("atball", "pos2"), FINAL})
    assert SOCCER.anchor(belief, SCENARIO, remembered) == expected | {FINAL}


def test_without_a_ball_in_play_everything_is_remembered():
    facts = frozenset({("robot", "way2"), ("visited", "way2"), ("route", "way2", "way3")})
    assert SOCCER.anchor(believe(), Scenario("waypoints", "", {}), facts) == facts


def test_approach_ends_behind_the_ball_and_dribbles_lead_from_rail_to_rail():
    place = np.array([[0.0, 0.0, 0.0, 0.0, 2.0, 1.0, math.pi / 2, 0.3]])
    approach = SOCCER.actions["approachBall"].arguments(place)[0]
    assert approach == pytest.approx([0.0, 0.0, 0.0, 0.0, 2.0, 1.0 - robot.BEHIND_BALL_M, math.pi / 2, 0.3])
    dribble = SOCCER.actions["dribbleBall"].arguments(place)[0]
    assert dribble == pytest.approx([-0.31, 0.0, 0.0, 0.0, 2.0, 0.69, math.pi / 2, 0.3])


# --- the belief -----------------------------------------------------------------------------------
def heard(message, arrival_ns):
    return Sample("", message, arrival_ns, 1)


BALL_AHEAD = heard(BallPercept(1_000_000, 2.0, 0.0, 1e-2, 1e-2, 0.0), 1_000_000)


def after(*samples, belief=None, now_ns=None):
    last = max(s.arrival_ns for s in samples)
    return SOCCER.update(belief or SOCCER.initial_belief(), now_ns or last, samples, (0.0, 0.0))


def pose_at(x, y, phi, arrival_ns):
    return heard(PoseEstimate(arrival_ns, x, y, phi, 0.002, 0.002, 0.0016), arrival_ns)


def test_belief_follows_the_robot_within_centimetres():
    body, belief, zero = new_body(SOCCER), SOCCER.initial_belief(), (0.0, 0.0)
    body.reset(np.random.default_rng(6), {"x": -1.0, "y": 0.5, "phi": 1.0, "ball_x": 1.0, "ball_y": 1.0})
    errors = []
    for tick in range(150):
        body.command((0.0, 0.0) if tick < 20 else (0.5, 0.5 * math.sin(0.1 * tick)))
        belief = SOCCER.update(belief, (tick + 1) * 100_000_000, newest(body.advance(100_000_000)), zero)
        truth = body.ground_truth()
        if tick > 20:
            errors.append(
                (math.hypot(belief.pose.x - truth.x, belief.pose.y - truth.y), abs(belief.pose.phi - truth.phi))
            )
    assert np.mean(errors, axis=0) == pytest.approx((0.0, 0.0), abs=0.06)
    assert SOCCER.ready(belief)


def test_lost_odometry_messages_lose_no_way():
    def odom(x, stamp_ns):
        return heard(Odometry(stamp_ns, x, 0.0, 0.0, 0.5, 0.0), stamp_ns)

    belief = after(pose_at(0.0, 0.0, 0.0, 1), odom(7.0, 20_000_000))
    assert after(odom(7.05, 120_000_000), belief=belief).pose.x - belief.pose.x == pytest.approx(0.05, abs=1e-6)


def test_restarted_odometry_does_not_throw_the_robot_across_the_field():
    def odom(x, stamp_ns):
        return heard(Odometry(stamp_ns, x, 0.0, 0.0, 0.4, 0.0), stamp_ns)

    belief = after(pose_at(0.0, 0.0, 0.0, 1), odom(7.0, 20_000_000))
    assert after(odom(0.0, 120_000_000), belief=belief).pose.x == pytest.approx(belief.pose.x + 0.04, abs=1e-3)


def test_outliers_are_doubted_and_a_moved_robot_is_believed_after_three():
    belief = after(*(pose_at(0.0, 0.0, 0.0, i * 100_000_000) for i in range(1, 20)))
    twice = after(*(pose_at(2.0, 1.0, 0.0, (20 + i) * 100_000_000) for i in range(2)), belief=belief)
    assert math.hypot(twice.pose.x, twice.pose.y) < 0.01
    mended = after(pose_at(0.0, 0.0, 0.0, 2_200_000_000), belief=twice)
    assert mended.poses_doubted == 0
    thrice = after(*(pose_at(2.0, 1.0, 0.0, (20 + i) * 100_000_000) for i in range(3)), belief=belief)
    assert (thrice.pose.x, thrice.pose.y) == (2.0, 1.0)
    assert not SOCCER.ready(thrice), "it settles first"
    assert [relocations(SOCCER, each) for each in (SOCCER.initial_belief(), belief, twice, thrice)] == [0, 0, 0, 1]
    later = after(pose_at(2.0, 1.0, 0.0, 2_400_000_000), BALL_AHEAD, belief=thrice, now_ns=2_500_000_000)
    assert relocations(SOCCER, later) == 1


def test_balls_stay_where_they_were_in_the_field_while_the_robot_is_carried():
    at_rest = [pose_at(1.0, -0.5, 0.8, i * 100_000_000) for i in range(1, 20)]
    second = Sample("ball2", dataclasses.replace(BALL_AHEAD.message, y=0.7), 1_950_000_000, 1)
    belief = after(*at_rest, BALL_AHEAD, second)
    carried = after(*(pose_at(-2.0, 1.0, -2.5, (20 + i) * 100_000_000) for i in range(3)), belief=belief)
    assert carried.relocated == 1
    assert carried.ball_xy == pytest.approx(belief.ball_xy, abs=0.01)
    assert carried.ball2_xy == pytest.approx(belief.ball2_xy, abs=0.01)
    assert math.hypot(carried.ball.ahead, carried.ball.left) == pytest.approx(math.dist(belief.ball_xy, (-2.0, 1.0)))


def test_a_ball_that_was_seen_before_the_first_pose_is_where_it_was_seen_from():
    belief = after(BALL_AHEAD, pose_at(1.0, -0.5, 0.0, 2_000_000_000))
    assert (belief.ball.ahead, belief.ball.left) == (BALL_AHEAD.message.x, BALL_AHEAD.message.y)


def test_two_percepts_within_a_millisecond_make_no_fast_ball():
    belief = after(pose_at(0.0, 0.0, 0.0, 1), BALL_AHEAD)
    nearer = heard(BallPercept(1_000_000, 1.95, 0.0, 1e-2, 1e-2, 0.0), BALL_AHEAD.arrival_ns + 100_000)
    ball = after(nearer, belief=belief).ball
    assert math.hypot(ball.vx, ball.vy) < 1.0


def test_ball_is_kept_in_the_field_while_the_robot_looks_away():
    ball = heard(BallPercept(1_000_000, 2.0, 0.0, 1e-4, 1e-4, 0.0), 1_000_000)
    belief = after(pose_at(0.0, 0.0, 0.0, 1), ball)
    turning = [heard(Odometry(i * 100_000_000, 0.0, 0.0, 0.1 * i, 0.0, 1.0), i * 100_000_000) for i in range(1, 16)]
    away = after(*turning, belief=belief)
    assert away.ball_xy == pytest.approx(belief.ball_xy, abs=0.25)
    assert away.ball.left < -1.5


def test_time_never_runs_backwards_in_the_belief():
    belief = after(pose_at(0.0, 0.0, 0.0, 500_000_000))
    late = after(heard(Odometry(1, 0.0, 0.0, 0.0, 0.5, 0.0), 100_000_000), belief=belief, now_ns=400_000_000)
    assert late.time_ns == belief.time_ns
    assert late.pose == belief.pose
