"""What is measured on a piece of writing, on motions whose answer is known."""

import numpy as np
import pytest

from tailor.executive.domains.arm.robot import PEN_M
from tailor.schemas.messages import ActionFinished, ExecStatus, InstantiatedAction, JointState, Parameter, Subgoals
from tailor.tools.figures.letters import draw_letters, draw_words
from tailor.tools.writing.measures import pen_m, rms_jerk, roughness, waypoint_errors_rad
from tailor.tools.writing.writing_track import WritingTrack, writing_track

TIMES = np.arange(0.0, 4.0, 0.02)


def moving(angles, velocities, waypoints=((0.0, 0.0),), arrivals=(3.9,), text="I"):
    zero = np.zeros(len(arrivals))
    return WritingTrack(
        "hand", text, "achieved", TIMES, angles, velocities, np.array(waypoints), np.array(arrivals), zero, 1.0
    )


def swinging(rate):
    """Both joints on a circle of radius 1 at `rate` rad/s: the jerk's magnitude is rate³ throughout."""
    angles = np.stack((np.cos(rate * TIMES), np.sin(rate * TIMES)), 1)
    return moving(angles, rate * np.stack((-np.sin(rate * TIMES), np.cos(rate * TIMES)), 1))


def test_jerk_of_a_circle_is_its_rate_cubed():
    assert rms_jerk(swinging(1.5)) == pytest.approx(1.5**3, rel=0.01)


def test_roughness_does_not_depend_on_how_fast_a_motion_is():
    slow, fast = swinging(1.0), swinging(1.0)
    fast = WritingTrack(
        "hand", "I", "", TIMES / 2, fast.angles, 2 * fast.velocities, fast.waypoints, fast.arrivals_s / 2,
        fast.predicted_s, 1.0,
    )  # fmt: skip
    assert roughness(fast) == pytest.approx(roughness(slow), abs=0.1)
    assert rms_jerk(fast) == pytest.approx(8 * rms_jerk(slow), rel=0.05)


def test_a_waypoints_error_is_the_distance_when_it_was_to_be_passed():
    line = np.stack((0.5 * TIMES, np.zeros_like(TIMES)), 1)
    said = moving(line, np.full_like(line, 0.5), waypoints=((0.5, 0.0), (1.0, 0.3)), arrivals=(1.0, 2.2))
    assert waypoint_errors_rad(said) == pytest.approx([0.0, np.hypot(0.1, 0.3)])


def test_the_page_is_seen_from_behind_the_arm():
    assert pen_m(np.array([[0.1, 0.0], [0.0, 0.1]])) == pytest.approx(0.1 * PEN_M * np.eye(2))


def goal(ag, bg):
    parameters = tuple(Parameter(n, k, "p", "rad", True, v, v, v) for k, (n, v) in enumerate((("ag", ag), ("bg", bg))))
    return InstantiatedAction("reach", 1, False, 1.0, 0.0, parameters)


def status(stamp_ns, action, result=""):
    return ExecStatus(stamp_ns, 1, "EXECUTING", "", "word-I", "", result, action, 0, 0.0, 0.0)


def test_a_run_is_cut_from_its_first_reach_to_its_last_waypoint():
    second = 1_000_000_000
    joints = ("lift", "pan")  # another order than ours
    states = [JointState(k * second // 10, joints, (1.0, 0.1 * k), (0.0, 1.0), (0.0, 0.0)) for k in range(60)]
    finished = [ActionFinished(3 * second, 1, "reach", 0, "done", "", 1.9, 2.0)]
    said = writing_track(
        "hand", "I", [*states, status(0, ""), status(second, "reach"), *finished, status(4 * second, "", "achieved"),
                      Subgoals(0, 1, 2, (goal(0.3, 0.4),))]
    )  # fmt: skip
    assert said.result == "achieved"
    assert said.times_s[[0, -1]] == pytest.approx([0.0, 2.1])
    assert said.angles[0] == pytest.approx([1.0, 1.0])
    assert said.arrivals_s == pytest.approx([2.1])
    assert said.waypoints.tolist() == [[0.3, 0.4]]


def test_a_run_that_never_began_is_empty():
    said = writing_track("hand", "I", [status(0, "")])
    assert said.duration_s == 0.0
    assert not said.pen_down().any()


def test_pictures_are_drawn(tmp_path):
    said = swinging(1.0)
    draw_letters([[said, said], [said, said]], tmp_path / "letters.png")
    draw_words([said, said], tmp_path / "word.png")
    assert all((tmp_path / name).stat().st_size > 10_000 for name in ("letters.png", "word.png"))
