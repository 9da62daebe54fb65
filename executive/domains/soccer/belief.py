"""The soccer robot's belief: where it is, how fast it goes, where the ball is (paper Table 5)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from executive.belief import ball_track, planar_ekf
from executive.belief.angles import difference
from executive.belief.ball_track import BallTrack
from executive.belief.planar_ekf import OdometryNoise, Pose
from executive.domains.soccer import robot
from schemas.messages import BallPercept, Odometry, PoseEstimate, Sample

ODOMETRY_NOISE = OdometryNoise(along=4e-4, across=1e-4, turn=1e-3, drift=2e-5)
POSE_ERROR_MEMORY = 10.0  # pose errors last about 0.6 s: so many percepts in a row err alike and count as one
FIRST_POSES = 5  # percepts before the first one's error has been averaged enough to drive
LOST_JUMP_M = 0.6  # a pose this far off is not noise: the robot was put elsewhere
LOST_JUMP_RAD = 0.6
LOST_POSES = 3  # so many such poses in a row, and they are believed
MOTION_LIMIT_S = 0.5  # without odometry for longer, the last velocity says nothing


@dataclass(frozen=True, slots=True)
class SoccerBelief:
    """State variables in the map frame (m, rad, m/s, rad/s); `ball` is in the robot's frame."""

    time_ns: int
    pose: Pose
    v: float
    omega: float
    moved_ns: int  # when odometry last came
    ball: BallTrack | None
    poses_seen: int
    poses_doubted: int = 0

    @property
    def ball_xy(self) -> tuple[float, float] | None:
        """The ball in the map frame, m; None before it was first seen."""
        if self.ball is None:
            return None
        c, s = math.cos(self.pose.phi), math.sin(self.pose.phi)
        ahead, left = self.ball.ahead, self.ball.left
        return self.pose.x + c * ahead - s * left, self.pose.y + s * ahead + c * left

    @property
    def holds_ball(self) -> bool:
        """Whether the ball lies in the rail."""
        return self.ball is not None and in_cradle(self.ball)


def unknown() -> SoccerBelief:
    """The belief before the first percept."""
    return SoccerBelief(0, Pose(0.0, 0.0, 0.0, (25.0, 0.0, 0.0, 25.0, 0.0, 10.0)), 0.0, 0.0, 0, None, 0)


def ready(belief: SoccerBelief) -> bool:
    """Enough to act on: the pose has settled and the ball has been seen."""
    return belief.poses_seen >= FIRST_POSES and belief.ball is not None


def in_cradle(ball: BallTrack) -> bool:
    """Whether a ball there is held by the rail."""
    near, far = robot.CRADLE_AHEAD_M
    return near < ball.ahead < far and abs(ball.left) < robot.CRADLE_LEFT_M


def update(belief: SoccerBelief, now_ns: int, samples: tuple[Sample, ...]) -> SoccerBelief:
    """Filter samples (oldest first) by their time of arrival, then predict to now."""
    for sample in samples:
        message = sample.message
        if isinstance(message, Odometry):
            belief = _drive(belief, sample.arrival_ns, message)
        elif isinstance(message, PoseEstimate):
            belief = _locate(_advance(belief, sample.arrival_ns), message)
        elif isinstance(message, BallPercept):
            belief = _see_ball(_advance(belief, sample.arrival_ns), message)
    return _advance(belief, now_ns)


def _advance(belief: SoccerBelief, to_ns: int) -> SoccerBelief:
    """Predict to a time; never backwards."""
    if to_ns <= belief.time_ns:
        return belief
    duration_s = 1e-9 * (to_ns - belief.time_ns) if belief.time_ns else 0.0
    stale = to_ns - belief.moved_ns > MOTION_LIMIT_S * 1e9
    v, omega = (0.0, 0.0) if stale else (belief.v, belief.omega)
    return _moved(belief, to_ns, duration_s, v, omega, belief.v, belief.omega, belief.moved_ns)


def _drive(belief: SoccerBelief, to_ns: int, odom: Odometry) -> SoccerBelief:
    """Odometry tells the mean velocity up to its arrival; before the first one the robot stood still."""
    if to_ns < belief.time_ns:
        return belief
    duration_s = 1e-9 * (to_ns - belief.time_ns) if belief.time_ns else 0.0
    v, omega = 0.5 * (belief.v + odom.v), 0.5 * (belief.omega + odom.omega)
    return _moved(belief, to_ns, duration_s, v, omega, odom.v, odom.omega, to_ns)


def _moved(
    belief: SoccerBelief,
    to_ns: int,
    duration_s: float,
    v: float,
    omega: float,
    v_now: float,
    omega_now: float,
    moved_ns: int,
) -> SoccerBelief:
    pose = planar_ekf.predict(belief.pose, v, omega, duration_s, ODOMETRY_NOISE)
    ball = belief.ball
    if ball is not None:
        middle = belief.pose.phi + 0.5 * omega * duration_s
        if in_cradle(ball) and _pushed(ball, v, middle):
            ball = ball_track.carry(ball, v, omega, middle, duration_s)
        else:
            ball = ball_track.move(ball, v, omega * duration_s, middle, duration_s, robot.BALL_ROLLING_MPS2)
    return SoccerBelief(to_ns, pose, v_now, omega_now, moved_ns, ball, belief.poses_seen, belief.poses_doubted)


def _pushed(ball: BallTrack, v: float, phi: float) -> bool:
    """Whether the robot drives at least as fast as the ball rolls ahead of it."""
    return v > 0.0 and v >= math.cos(phi) * ball.vx + math.sin(phi) * ball.vy - 0.15


def _locate(belief: SoccerBelief, seen: PoseEstimate) -> SoccerBelief:
    if belief.poses_seen == 0:
        return _relocated(belief, seen)
    off_m = math.hypot(seen.x - belief.pose.x, seen.y - belief.pose.y)
    if off_m > LOST_JUMP_M or abs(difference(seen.phi, belief.pose.phi)) > LOST_JUMP_RAD:
        doubted = belief.poses_doubted + 1
        if doubted >= LOST_POSES:
            return _relocated(belief, seen)
        return _with_pose(belief, belief.pose, belief.poses_seen, doubted)
    variances = (POSE_ERROR_MEMORY * seen.var_x, POSE_ERROR_MEMORY * seen.var_y, POSE_ERROR_MEMORY * seen.var_phi)
    pose = planar_ekf.correct(belief.pose, seen.x, seen.y, seen.phi, variances)
    return _with_pose(belief, pose, belief.poses_seen + 1, 0)


def _relocated(belief: SoccerBelief, seen: PoseEstimate) -> SoccerBelief:
    pose = Pose(seen.x, seen.y, seen.phi, (seen.var_x, 0.0, 0.0, seen.var_y, 0.0, seen.var_phi))
    return _with_pose(belief, pose, 1, 0)


def _with_pose(belief: SoccerBelief, pose: Pose, seen: int, doubted: int) -> SoccerBelief:
    return SoccerBelief(belief.time_ns, pose, belief.v, belief.omega, belief.moved_ns, belief.ball, seen, doubted)


def _see_ball(belief: SoccerBelief, seen: BallPercept) -> SoccerBelief:
    variance = 0.5 * (seen.var_x + seen.var_y)
    ball = ball_track.see(belief.ball, seen.x, seen.y, variance, belief.pose.phi, belief.time_ns)
    return SoccerBelief(
        belief.time_ns,
        belief.pose,
        belief.v,
        belief.omega,
        belief.moved_ns,
        ball,
        belief.poses_seen,
        belief.poses_doubted,
    )
