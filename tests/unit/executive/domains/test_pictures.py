"""Where the camera has not looked for opponents yet, the robot turns on the spot before it drives."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tailor.executive import domains
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.soccer import belief as soccer
from tailor.executive.domains.soccer import opponents, pictures
from tailor.tools.lockstep.action_run import new_body
from tailor.tools.lockstep.readings import newest

SOCCER = domains.load("soccer")
GO = SOCCER.actions["goToPose"].controller
SECOND_NS = 10**9
COVARIANCE = (4e-4, 0.0, 0.0, 4e-4, 0.0, 2e-4)


def posed(x=0.0, y=0.0, phi=0.0):
    return Pose(x, y, phi, COVARIANCE)


def believing(*poses):
    """The belief of a robot at the last of the poses, that has searched a picture at each for opponents."""
    taken = ()
    for pose in poses:
        taken = pictures.with_picture(taken, pose)
    known = opponents.Opponents((), SECOND_NS, taken)
    return replace(soccer.unknown(), pose=poses[-1], poses_seen=99, time_ns=SECOND_NS, opponents=known)


def going(believed, bearing):
    """The command (v, omega) of goToPose to a pose 2 m away in this direction."""
    x, y, phi = believed.pose.x, believed.pose.y, believed.pose.phi + bearing
    goal = np.array([0.0, 0.0, 0.0, 0.0, x + 2 * math.cos(phi), y + 2 * math.sin(phi), phi, 0.0])
    return GO(None, SECOND_NS, believed, goal).command


@pytest.mark.parametrize("bearing", [1.2, -1.2])
def test_the_robot_turns_on_the_spot_to_where_no_picture_was_taken(bearing):
    v, omega = going(believing(posed()), bearing)
    assert v == 0.0
    assert omega * bearing > 0.5


def test_the_robot_drives_as_it_turns_to_where_a_picture_was_taken():
    assert going(believing(posed(phi=1.2), posed(phi=0.5), posed()), 1.2)[0] > 0.1, "it has looked there"
    assert going(believing(posed()), 0.6)[0] > 0.1, "it looks there"
    driven = [posed(x=0.2 * k - 1.0) for k in range(6)]
    assert going(believing(*driven), -1.2)[0] > 0.1, "it has seen that side as it came"


def test_without_opponents_to_look_for_the_robot_drives_as_it_turns():
    believed = replace(believing(posed()), opponents=opponents.NONE)
    assert going(believed, 1.2)[0] > 0.1


def test_the_camera_does_not_show_what_is_too_near_for_it():
    assert not pictures.in_view((0.0, 0.0, 0.0), (0.3, 0.0))
    assert pictures.in_view((0.0, 0.0, 0.0), (0.6, 0.0))


def test_a_robot_that_stands_remembers_one_picture_and_one_that_was_moved_none_from_before():
    taken = ()
    for k in range(20):
        taken = pictures.with_picture(taken, posed(x=0.001 * k))
    assert len(taken) == 1
    assert pictures.with_picture(taken, posed(x=2.0)) == ((2.0, 0.0, 0.0),)


def test_the_newest_pictures_are_remembered():
    taken = ()
    for k in range(3 * pictures.MOST):
        taken = pictures.with_picture(taken, posed(x=0.2 * k))
    assert len(taken) == pictures.MOST
    assert taken[-1][0] == pytest.approx(0.2 * (3 * pictures.MOST - 1))


@pytest.mark.parametrize("seed", range(6))
def test_an_opponent_beside_the_robot_counts_before_the_robot_leaves_its_place(seed):
    body, believed = new_body(SOCCER), SOCCER.initial_belief()
    beside = 0.75 * math.cos(1.2), 0.75 * math.sin(1.2)  # the camera sees 0.87 rad
    start = {"x": 0.0, "y": 0.0, "phi": 0.0, "opponent1_x": beside[0], "opponent1_y": beside[1]}
    body.reset(np.random.default_rng(seed), start)
    goal = np.array([0.0, 0.0, 0.0, 0.0, 2 * math.cos(1.4), 2 * math.sin(1.4), 1.4, 0.0])
    command, state = (0.0, 0.0), None
    for tick in range(1, 80):
        body.command(command)
        believed = SOCCER.update(believed, tick * 10**8, newest(body.advance(10**8)), command)
        if believed.opponents.standing:
            break
        if SOCCER.ready(believed):
            control = GO(state, tick * 10**8, believed, goal)
            command, state = control.command, control.state
    assert believed.opponents.standing
    assert math.hypot(believed.pose.x, believed.pose.y) < 0.1
