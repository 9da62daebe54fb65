"""The judge of a soak sees motion and arming without leave, late stops and late rest, and nothing else."""

from __future__ import annotations

import pytest

from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.tools.soak.judging.motion import MotionJudge
from tailor.tools.soak.judging.robots import ROBOTS, rest_threshold, speeds_of
from tailor.tools.soak.judging.violations import Invariant

AGILO = ROBOTS[0]
S = 1_000_000_000


class Judged:
    """A judge and what it reports; times in seconds."""

    def __init__(self):
        self.reported: list[tuple[Invariant, str]] = []
        self.judge = MotionJudge(AGILO, lambda now_ns, invariant, detail: self.reported.append((invariant, detail)))

    def driver(self, at_s, mode, epoch=1):
        self.judge.driver(round(at_s * S), mode, epoch)

    def truth(self, at_s, v=0.0, omega=0.0):
        self.judge.truth(round(at_s * S), (v, omega))

    def invariants(self):
        return [invariant for invariant, _ in self.reported]


@pytest.fixture
def judged():
    """Launched at 1 s, armed by the launcher's leave at 2 s, in motion at 0.65 m/s until 3 s."""
    judged = Judged()
    judged.judge.launched(1 * S)
    judged.driver(1.5, "disarmed")
    judged.driver(2.0, "armed")
    for tenth in range(11):
        judged.truth(2.0 + tenth / 10, 0.65)
    return judged


def stop(judged, at_s=3.1):
    judged.judge.revoke(3 * S, 0.3)
    judged.driver(at_s, "stopped")


def test_motion_with_the_launchers_leave_is_fine(judged):
    judged.judge.check(4 * S)
    assert judged.reported == []
    assert judged.judge.permitted


def test_a_stop_in_time_and_rest_in_time_is_fine(judged):
    stop(judged)
    judged.truth(4.3, 0.05)  # 0.65 m/s take 1 s at 0.65 m/s²
    judged.truth(4.5)
    judged.judge.check(5 * S)
    assert judged.reported == []
    assert (judged.judge.zero_ns, judged.judge.rest_ns) == (round(3.1 * S), round(4.5 * S))


def test_a_late_stop_is_reported_with_its_time(judged):
    stop(judged, 3.37)
    assert judged.reported == [(Invariant.ZERO_IN_TIME, "zero 0.370 s after its cause")]


def test_a_stop_that_never_comes_is_reported(judged):
    judged.judge.revoke(3 * S, 0.3)
    judged.judge.check(round(3.39 * S))
    assert judged.reported == []
    judged.judge.check(round(3.41 * S))
    assert judged.invariants() == [Invariant.ZERO_IN_TIME]


def test_rest_that_comes_late_is_reported_once(judged):
    stop(judged)
    judged.truth(4.41, 0.03)
    judged.truth(4.51, 0.03)
    assert judged.reported == [(Invariant.REST_IN_TIME, "still 0.030, 0.000, 0.01 s late")]


@pytest.mark.parametrize("motion", [{"v": 0.021}, {"omega": -0.021}, {"v": float("nan")}])
def test_motion_after_the_stop_is_unasked(judged, motion):
    stop(judged)
    judged.truth(4.4)
    judged.truth(6.0, **motion)
    assert Invariant.UNASKED_MOTION in judged.invariants()


@pytest.mark.parametrize(("ball_m", "threshold"), [(0.3, 0.3), (0.41, 0.02)])
def test_a_ball_that_touches_the_robot_may_jolt_it(judged, ball_m, threshold):
    stop(judged)
    truth = SoccerGroundTruth(0, 0.0, 0.0, 0.0, -0.028, 0.145, ball_m, 0.0, -0.1, 0.0)
    assert rest_threshold(truth) == threshold
    judged.judge.truth(6 * S, speeds_of(truth), rest_threshold(truth))
    assert judged.invariants() == ([] if threshold > 0.145 else [Invariant.UNASKED_MOTION])
    judged.judge.truth(7 * S, (0.31, 0.0), rest_threshold(truth))
    assert judged.invariants() == [Invariant.UNASKED_MOTION]


def test_arming_after_the_stop_is_unasked(judged):
    stop(judged)
    judged.driver(3.2, "armed")
    assert judged.invariants() == [Invariant.UNASKED_ARMING]


def test_reports_of_the_armed_driver_may_still_arrive_before_its_stop(judged):
    judged.judge.revoke(3 * S, 0.3)
    judged.driver(3.2, "armed")
    assert judged.reported == []


def test_a_driver_that_starts_armed_is_unasked_arming(judged):
    judged.judge.revoke(3 * S)
    judged.driver(3.2, "armed", epoch=2)
    assert judged.invariants() == [Invariant.UNASKED_ARMING]


def test_a_restart_of_the_driver_revokes_the_leave(judged):
    judged.driver(3.1, "disarmed", epoch=2)
    assert not judged.judge.permitted


def test_the_drivers_own_stop_revokes_the_leave(judged):
    judged.driver(3.1, "stopped")
    judged.truth(6.0, 0.5)
    assert judged.judge.stops == 1
    assert Invariant.UNASKED_MOTION in judged.invariants()


def test_people_give_leave_again(judged):
    stop(judged)
    judged.truth(4.4)
    judged.judge.people_arm(5 * S)
    judged.driver(5.05, "stopped")  # a report from before
    judged.driver(5.1, "armed")
    judged.truth(5.5, 0.5)
    assert judged.reported == []
    assert judged.judge.permitted


def test_a_leave_that_is_not_used_expires(judged):
    stop(judged)
    judged.judge.people_arm(5 * S)
    judged.driver(7.1, "stopped")
    judged.driver(7.2, "armed")
    assert judged.invariants() == [Invariant.UNASKED_ARMING]


@pytest.mark.parametrize(("v", "omega"), [(1.0, 0.0), (0.0, -2.0), (float("nan"), 0.0), (float("inf"), 0.0)])
def test_a_body_beyond_its_limits_is_reported(judged, v, omega):
    judged.truth(3.1, v, omega)
    assert judged.invariants() == [Invariant.OUTPUT_LIMITS]


@pytest.mark.parametrize("values", [(0.9001, 0.0), (float("nan"), 0.0), (0.5,), ()])
def test_a_command_beyond_the_limits_is_reported(judged, values):
    judged.judge.command(3 * S, values)
    assert judged.invariants() == [Invariant.OUTPUT_LIMITS]


def test_a_command_on_the_limit_is_fine(judged):
    judged.judge.command(3 * S, (0.9, -1.75))
    assert judged.reported == []


def test_quiet_counts_from_the_stop_and_from_the_last_motion(judged):
    stop(judged)
    judged.truth(3.5, 0.3)
    assert not judged.judge.at_rest_since(round(5.4 * S), 2 * S)
    assert judged.judge.at_rest_since(round(5.6 * S), 2 * S)
