"""The soccer robot's belief: pose and velocity of the robot, places of balls and opponents (paper Table 5)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from tailor.executive.belief import ball_track, planar_ekf
from tailor.executive.belief.angles import difference
from tailor.executive.belief.ball_track import BallTrack, Seen
from tailor.executive.belief.planar_ekf import OdometryNoise, Pose
from tailor.executive.domains.soccer import opponents, robot
from tailor.executive.domains.soccer.opponents import Opponents
from tailor.schemas.messages import Odometry, PoseEstimate, Sample
from tailor.schemas.messages.soccer import BallPercept, OpponentPercepts
from tailor.schemas.topics import key_of

ODOMETRY_NOISE = OdometryNoise(along=4e-4, across=1e-4, turn=1e-3, drift=2e-5)
POSE_ERROR_MEMORY = 10.0  # pose errors last about 0.6 s: so many percepts have one error and count as one
FIRST_POSES = 12  # percepts that average the error of the first one enough to drive
LOOKING_POSES = 25  # percepts during which the robot looks for a ball before it drives without one
LOST_JUMP_M = 0.6  # a pose this far off is not noise: the robot was moved
LOST_JUMP_RAD = 0.6
LOST_POSES = 3  # so many such poses in a row relocate the belief
CREDIBLE_MPS = 1.5  # a faster odometry was restarted in between
CREDIBLE_RADPS = 3.0
# m² or rad². ROS nodes without a covariance send zeros: the minimum is a millimetre's, the maximum that of 5 m
VARIANCES = (1e-6, 25.0)
BALL2 = "ball2"  # topic of the second ball
MOTION_LIMIT_S = 0.5  # without odometry for longer, the last velocity is not extrapolated


@dataclass(frozen=True, slots=True)
class SoccerBelief:
    """State variables in the map frame (m, rad, m/s, rad/s); balls are in the robot's frame."""

    time_ns: int
    pose: Pose
    v: float
    omega: float
    moved_ns: int  # arrival of the last odometry
    ball: BallTrack | None
    poses_seen: int
    poses_doubted: int = 0
    odom: Odometry | None = None  # the last one
    opponents: Opponents = opponents.NONE
    ball2: BallTrack | None = None  # where two balls are in play
    relocated: int = 0  # how often the robot was moved by others

    @property
    def ball_xy(self) -> tuple[float, float] | None:
        """The ball in the map frame, m; None before it was first seen."""
        return None if self.ball is None else _in_map(self.pose, self.ball)

    @property
    def ball2_xy(self) -> tuple[float, float] | None:
        """The second ball in the map frame, m; None before it was first seen."""
        return None if self.ball2 is None else _in_map(self.pose, self.ball2)


def _in_map(pose: Pose, ball: BallTrack) -> tuple[float, float]:
    c, s = math.cos(pose.phi), math.sin(pose.phi)
    return pose.x + c * ball.ahead - s * ball.left, pose.y + s * ball.ahead + c * ball.left


def unknown() -> SoccerBelief:
    """The belief before the first percept."""
    return SoccerBelief(0, Pose(0.0, 0.0, 0.0, (25.0, 0.0, 0.0, 25.0, 0.0, 10.0)), 0.0, 0.0, 0, None, 0)


def ready(belief: SoccerBelief) -> bool:
    """Whether the pose has settled, the ball has been seen or sought long enough, and opponents are looked for."""
    needed = FIRST_POSES if belief.ball is not None or belief.ball2 is not None else LOOKING_POSES
    return belief.poses_seen >= needed and opponents.fresh(belief.opponents, belief.time_ns)


def in_cradle(ball: BallTrack) -> bool:
    """Whether the rail holds a ball at this place."""
    near, far = robot.CRADLE_AHEAD_M
    return near < ball.ahead < far and abs(ball.left) < robot.CRADLE_LEFT_M


def update(belief: SoccerBelief, now_ns: int, samples: tuple[Sample, ...], robot_name: str) -> SoccerBelief:
    """Filter samples (oldest first) by their time of arrival, then predict to now.

    Args:
      belief: The belief before.
      now_ns: Monotonic time to predict to.
      samples: Each by the key of its topic, or by the topic's name where there is no bus.
      robot_name: The robot in the keys.
    """
    of_second_ball = (BALL2, key_of(BALL2, robot_name))
    for sample in samples:
        message = sample.message
        if isinstance(message, Odometry):
            belief = _drive(belief, sample.arrival_ns, message)
        elif isinstance(message, PoseEstimate):
            belief = _locate(_advance(belief, sample.arrival_ns), message)
        elif isinstance(message, BallPercept):
            belief = _see_ball(_advance(belief, sample.arrival_ns), message, sample.key in of_second_ball)
        elif isinstance(message, OpponentPercepts):
            belief = _advance(belief, sample.arrival_ns)
            seen = opponents.see(belief.opponents, belief.pose, belief.time_ns, message)
            belief = replace(belief, opponents=seen)
    return _advance(belief, now_ns)


def _advance(belief: SoccerBelief, to_ns: int) -> SoccerBelief:
    """Predict to a time; times before the belief's are ignored."""
    if to_ns <= belief.time_ns:
        return belief
    duration_s = 1e-9 * (to_ns - belief.time_ns) if belief.time_ns else 0.0
    stale = to_ns - belief.moved_ns > MOTION_LIMIT_S * 1e9
    v, omega = (0.0, 0.0) if stale else (belief.v, belief.omega)
    return _moved(belief, to_ns, duration_s, v, omega, belief.odom, belief.moved_ns)


def _drive(belief: SoccerBelief, to_ns: int, odom: Odometry) -> SoccerBelief:
    """Predict to the arrival of odometry with its mean velocity; odometry beyond the robot's speed is ignored."""
    if to_ns < belief.time_ns or abs(odom.v) > CREDIBLE_MPS or abs(odom.omega) > CREDIBLE_RADPS:
        return belief
    duration_s = 1e-9 * (to_ns - belief.time_ns) if belief.time_ns else 0.0
    v, omega = _mean_velocity(belief, odom)
    return _moved(belief, to_ns, duration_s, v, omega, odom, to_ns)


def _mean_velocity(belief: SoccerBelief, odom: Odometry) -> tuple[float, float]:
    """From the dead-reckoned poses, which lost messages do not affect; otherwise from the velocities."""
    last = belief.odom
    if last is None:
        return 0.5 * odom.v, 0.5 * odom.omega
    between_s = 1e-9 * (odom.stamp_ns - last.stamp_ns)
    if 0.0 < between_s < MOTION_LIMIT_S:
        turn = difference(odom.phi, last.phi)
        middle = last.phi + 0.5 * turn
        distance = math.cos(middle) * (odom.x - last.x) + math.sin(middle) * (odom.y - last.y)
        if abs(distance) < CREDIBLE_MPS * between_s and abs(turn) < CREDIBLE_RADPS * between_s:
            return distance / between_s, turn / between_s
    return 0.5 * (last.v + odom.v), 0.5 * (last.omega + odom.omega)


def _moved(
    belief: SoccerBelief,
    to_ns: int,
    duration_s: float,
    v: float,
    omega: float,
    odom: Odometry | None,
    moved_ns: int,
) -> SoccerBelief:
    pose = planar_ekf.predict(belief.pose, v, omega, duration_s, ODOMETRY_NOISE)
    middle = belief.pose.phi + 0.5 * omega * duration_s
    ball = _ball_moved(belief.ball, v, omega, middle, duration_s)
    ball2 = _ball_moved(belief.ball2, v, omega, middle, duration_s)
    v_now, omega_now = (odom.v, odom.omega) if odom is not None else (belief.v, belief.omega)
    b, counts = belief, (belief.poses_seen, belief.poses_doubted)
    return SoccerBelief(to_ns, pose, v_now, omega_now, moved_ns, ball, *counts, odom, b.opponents, ball2, b.relocated)


def _ball_moved(ball: BallTrack | None, v: float, omega: float, phi: float, duration_s: float) -> BallTrack | None:
    """The ball after a step in which the robot drives with its heading `phi` in the middle."""
    if ball is None:
        return None
    if in_cradle(ball) and _pushed(ball, v, phi):
        return ball_track.carry(ball, v, omega, phi, duration_s)
    return ball_track.move(ball, v, omega * duration_s, phi, duration_s, robot.BALL_ROLLING_MPS2)


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
    x, y, phi = _variances(seen)
    variances = (POSE_ERROR_MEMORY * x, POSE_ERROR_MEMORY * y, POSE_ERROR_MEMORY * phi)
    pose = planar_ekf.correct(belief.pose, seen.x, seen.y, seen.phi, variances)
    return _with_pose(belief, pose, belief.poses_seen + 1, 0)


def _relocated(belief: SoccerBelief, seen: PoseEstimate) -> SoccerBelief:
    x, y, phi = _variances(seen)
    pose = Pose(seen.x, seen.y, seen.phi, (x, 0.0, 0.0, y, 0.0, phi))
    located = _with_pose(belief, pose, 1, 0)
    if not belief.poses_seen:  # the first pose: balls have only been seen from where the robot is
        return replace(located, opponents=opponents.NONE)
    ball, ball2 = (_left_behind(each, belief.pose, pose) for each in (belief.ball, belief.ball2))
    return replace(located, opponents=opponents.NONE, ball=ball, ball2=ball2, relocated=belief.relocated + 1)


def _left_behind(ball: BallTrack | None, before: Pose, now: Pose) -> BallTrack | None:
    """A ball that stays where it was in the map while somebody carries the robot from one pose to another."""
    if ball is None:
        return None
    x, y = _in_map(before, ball)
    c, s = math.cos(now.phi), math.sin(now.phi)
    return replace(ball, ahead=c * (x - now.x) + s * (y - now.y), left=c * (y - now.y) - s * (x - now.x))


def _variances(seen: PoseEstimate) -> tuple[float, float, float]:
    return _bounded(seen.var_x), _bounded(seen.var_y), _bounded(seen.var_phi)


def _bounded(variance: float) -> float:
    lower, upper = VARIANCES
    return min(upper, max(lower, variance))


def _with_pose(belief: SoccerBelief, pose: Pose, seen: int, doubted: int) -> SoccerBelief:
    b = belief
    old = b.moved_ns, b.ball, seen, doubted, b.odom, b.opponents, b.ball2, b.relocated
    return SoccerBelief(b.time_ns, pose, b.v, b.omega, *old)


def _see_ball(belief: SoccerBelief, seen: BallPercept, second: bool) -> SoccerBelief:
    b, ball, ball2 = belief, belief.ball, belief.ball2
    if second:
        ball2 = ball_track.see(ball2, _sight(seen), b.pose.phi, b.time_ns)
    else:
        ball = ball_track.see(ball, _sight(seen), b.pose.phi, b.time_ns)
    counts = b.poses_seen, b.poses_doubted  # the constructor is five times faster than dataclasses.replace
    balls = ball, *counts, b.odom, b.opponents, ball2, b.relocated
    return SoccerBelief(b.time_ns, b.pose, b.v, b.omega, b.moved_ns, *balls)


def _sight(seen: BallPercept) -> Seen:
    """The percept with a valid covariance matrix, whatever was received."""
    var_ahead, var_left = _bounded(seen.var_x), _bounded(seen.var_y)
    limit = math.sqrt(var_ahead * var_left)
    return Seen(seen.x, seen.y, var_ahead, var_left, min(limit, max(-limit, seen.cov_xy)))
