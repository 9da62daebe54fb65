"""dribbleBall: push the ball in the rail to a pose, on a path that the ball can follow; fetch a lost ball."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from tailor.executive.actions.dribble_path import DribblePath
from tailor.executive.actions.fetch_ball import SEEKING, FetchBall, Stage
from tailor.executive.actions.path_follower import Pace, Progress, project, speed_limit, tracking_curvature
from tailor.executive.actions.planar import VG, XG, BallBelief
from tailor.executive.actions.rail_grip import RailGrip
from tailor.executive.belief.angles import difference
from tailor.executive.belief.ball_track import BallTrack
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.interfaces.action import Control
from tailor.executive.interfaces.values import Array

TICK_S = 0.1  # the controller's period
SEEKING_NS = 8_000_000_000  # limit of a search; a full turn takes 7 s
LONGEST_NS = 200_000_000  # of a search, between two calls; for longer the executive held the robot


@dataclass(frozen=True, slots=True)
class Pushing:
    """Controller state while the ball is in the rail: progress, last command (m/s, rad/s), whether the ball slips."""

    progress: Progress
    v: float
    omega: float
    slipping: bool = False


@dataclass(frozen=True, slots=True)
class Fetching:
    """Controller state while the ball is lost."""

    stage: Stage
    sought_ns: int = 0  # time of the search so far, while the robot was not held
    called_ns: int = 0  # last call of the search
    far: bool = True  # it was farther off than a ball that lies before the rail as a dribble begins


@dataclass(frozen=True, slots=True)
class DribbleBall:
    """Follows a Dubins path within the limits of the rail's grip, with feedback from the ball's slip."""

    fetch: FetchBall
    grip: RailGrip
    v_max_mps: float = 0.75
    bend_push_rad: float = 0.945  # planned in bends: direction in which the rail pushes
    omega_max_radps: float = 0.66  # the difference is for corrections; the rail holds 0.75 permanently
    yaw_radps2: float = 1.0  # so that the ball follows
    tightest_per_m: float = 3.0  # highest omega / v: slower than that the ball rolls out aside
    speeding_up_mps2: float = 0.5
    braking_mps2: float = 0.35  # the ball must not roll out of the rail: it slows by 0.53 by itself
    bend_braking_mps2: float = 0.20  # in a bend most of that force is needed to turn the ball
    min_braking_mps2: float = 0.05  # so that it can stop
    preview_s: float = 0.6  # lag of turning behind the command
    settle_m: float = 0.4
    slip_aside_m: float = 0.035  # so far aside or ahead of the rail's bottom the ball is slipping out
    slip_ahead_m: float = 0.09  # the camera measures the offset aside twice as precisely
    seated_again_m: float = 0.012
    catch_up_mps: float = 0.1  # faster than the path's limit, at most
    chase_radps: float = 1.0  # rad/s per rad of the ball's bearing when it slips
    lost_m: float = 0.17  # from the bottom of the rail: to be fetched
    gone_m: float = 0.90  # beyond, another approach is faster than fetching
    # A ball that was out of the rail, and whose way to the goal is longer than the straight line by as much once it is
    # fetched, is left and approached from another side. From 1.5 to 3.2 the same on 60 training seeds; with 4.2 the
    # robot circles.
    detour_m: float = 2.5
    seated_ahead_m: float = 0.035  # pushing begins when the ball is this near to the bottom
    seated_aside_m: float = 0.035
    off_path_m: float = 0.60  # plan a new path
    near_m: float = 0.35  # past the end and within this distance of the goal it has arrived; another round costs more
    heading_rad: float = 1.50
    reached_m: float = 0.05
    speed_mps: float = 0.10

    def __call__(self, state: Any, now_ns: int, belief: BallBelief, arguments: Array) -> Control:
        """See tailor.executive.interfaces.action.Controller; arguments are poses of the axle, not of the ball."""
        goal = tuple(arguments[XG : VG + 1].tolist())
        ball = belief.ball
        if ball is None:
            return Control(state, (0.0, 0.0), "failed", "the ball was never seen")
        stage: Stage = state.stage if isinstance(state, Fetching) else "chase"
        if stage != "leave" and self.fetch.misses(stage, ball, now_ns):
            return self._seek(state, now_ns, belief, ball)
        ahead, left = ball.ahead - self.grip.in_rail_m, abs(ball.left)
        if math.hypot(ahead, left) > self.gone_m or (stage == "leave" and self.fetch.left(ball)):
            return Control(state, (0.0, 0.0), "failed", "the ball got away")
        out = math.hypot(ahead, left) > self.lost_m
        unseated = ahead > self.seated_ahead_m or left > self.seated_aside_m
        if stage == "leave" or (unseated and (out or not isinstance(state, Pushing))):
            far = out or (isinstance(state, Fetching) and state.far)
            if out and self._fetched_detour_m(belief, ball, goal) > self.detour_m:
                stage = "leave"
            return self._retrieve("chase" if stage in SEEKING else stage, belief, ball, far)
        if not isinstance(state, Pushing):
            path = self._plan(belief.pose, belief.v, goal)
            if isinstance(state, Fetching) and state.far and self._detour_m(path, belief.pose, goal) > self.detour_m:
                return self._retrieve("leave", belief, ball, far=True)
            state = Pushing(path, max(0.0, belief.v), belief.omega)
        return self._push(state, belief, ball, goal)

    def _plan(self, pose: Pose, v: float, goal: tuple[float, ...]) -> Progress:
        paths = DribblePath(
            self.v_max_mps, self._bend_mps, self.grip.in_rail_m, self.speeding_up_mps2, self.braking_mps2
        )
        return Progress(paths.quickest(pose, v, goal), 0.0)

    def _fetched_detour_m(self, belief: BallBelief, ball: BallTrack, goal: tuple[float, ...]) -> float:
        """The detour of the ball once it is fetched, m."""
        fetched = self.fetch.fetched(belief.pose, ball, self.grip.rolling_mps2)
        return self._detour_m(self._plan(fetched, self.fetch.touch_mps, goal), fetched, goal)

    def _detour_m(self, path: Progress, pose: Pose, goal: tuple[float, ...]) -> float:
        """By how much the way of a ball in the rail is longer than the straight line to its place, m."""
        return path.remaining_m - self._ball_off_m(pose, goal)

    def _push(self, state: Pushing, belief: BallBelief, ball: BallTrack, goal: tuple[float, ...]) -> Control:
        pose = belief.pose
        progress, off = project(state.progress, pose, 0.3)
        if self._arrived(progress, belief, goal):
            return Control(state, (goal[3], 0.0), "done")
        slipping = self._slips(ball, state.slipping)
        if abs(off.aside_m) > self.off_path_m or self._missed(progress, pose, goal):
            progress = self._plan(pose, state.v, goal)
        pace = self._pace(progress.path.radius)
        limit = speed_limit(progress, goal[3], pace)
        speed = max(belief.v, 0.1)
        omega = speed * tracking_curvature(progress, off, speed * self.preview_s, self.settle_m)
        creeping = self._creeping(ball, omega)
        limit = min(self.v_max_mps, limit + creeping * self.catch_up_mps)
        omega *= 1.0 - creeping
        if slipping:
            limit = min(self.v_max_mps, limit + self.catch_up_mps)
            omega = self.chase_radps * math.atan2(ball.left, ball.ahead)
        v = self._ramp(state, limit)
        bound = min(self.omega_max_radps, max(0.2, self.tightest_per_m * belief.v))
        omega = max(-bound, min(bound, omega))
        if not slipping:
            omega = self._turn(state, (state.v - v) / TICK_S, omega)
        return Control(Pushing(progress, v, omega, slipping), (v, omega))

    def _creeping(self, ball: BallTrack, omega: float) -> float:
        """How far the ball has crept to the outside of the turn: 0 at the bottom of the rail, 1 where it slips out."""
        if omega == 0.0:
            return 0.0  # straight on, no side is the outside
        outside = math.copysign(ball.left, -omega * ball.left) - self.seated_again_m
        return max(0.0, min(1.0, outside / (self.slip_aside_m - self.seated_again_m)))

    def _slips(self, ball: BallTrack, before: bool) -> bool:
        """Whether the ball is leaving the rail, or was and is not yet back at the bottom."""
        ahead, aside = ball.ahead - self.grip.in_rail_m, abs(ball.left)
        if before:
            return aside > self.seated_again_m or ahead > self.slip_ahead_m
        return aside > self.slip_aside_m or ahead > self.slip_ahead_m

    def _bend_mps(self, radius: float) -> float:
        return self.grip.bend_mps(radius, self.bend_push_rad)

    def _pace(self, radius: float) -> Pace:
        return Pace(self.v_max_mps, self._bend_mps(radius), self.braking_mps2, self.bend_braking_mps2)

    def _ramp(self, state: Pushing, limit: float) -> float:
        """The next commanded speed: towards the limit within the ball's acceleration limits."""
        braking = min(self.braking_mps2, max(self.min_braking_mps2, self.grip.braking_mps2(state.v, state.omega)))
        return max(state.v - braking * TICK_S, min(limit, state.v + self.speeding_up_mps2 * TICK_S))

    def _turn(self, state: Pushing, braking_mps2: float, wanted: float) -> float:
        """The next commanded yaw rate; it grows only as fast as the ball follows."""
        growth = min(self.yaw_radps2, self.grip.yaw_radps2(state.v, state.omega, braking_mps2))
        up, down = growth * TICK_S, self.yaw_radps2 * TICK_S
        left, right = (up, down) if state.omega >= 0.0 else (down, up)
        return max(state.omega - right, min(state.omega + left, wanted))

    def _missed(self, progress: Progress, pose: Pose, goal: tuple[float, ...]) -> bool:
        """Whether the robot is past the end of the path without having arrived."""
        if progress.remaining_m > 0.0:
            return False
        return self._ball_off_m(pose, goal) > self.near_m or abs(difference(goal[2], pose.phi)) > self.heading_rad

    def _arrived(self, progress: Progress, belief: BallBelief, goal: tuple[float, ...]) -> bool:
        pose = belief.pose
        return (
            progress.remaining_m < self.reached_m
            and self._ball_off_m(pose, goal) < self.near_m
            and abs(difference(goal[2], pose.phi)) < self.heading_rad
            and belief.v < goal[3] + self.speed_mps
        )

    def _ball_off_m(self, pose: Pose, goal: tuple[float, ...]) -> float:
        """Distance (m) between a ball in the rail and its place at the goal."""
        dx = goal[0] - pose.x + self.grip.in_rail_m * (math.cos(goal[2]) - math.cos(pose.phi))
        dy = goal[1] - pose.y + self.grip.in_rail_m * (math.sin(goal[2]) - math.sin(pose.phi))
        return math.hypot(dx, dy)

    def _seek(self, state: Any, now_ns: int, belief: BallBelief, ball: BallTrack) -> Control:
        """Turn in one direction until the ball is seen."""
        if not (isinstance(state, Fetching) and state.stage in SEEKING):
            state = Fetching("seek left" if ball.left > 0.0 else "seek right", called_ns=now_ns)
        sought_ns = state.sought_ns + min(now_ns - state.called_ns, LONGEST_NS)
        if sought_ns > SEEKING_NS:
            return Control(state, (0.0, 0.0), "failed", "the ball was not found")
        _, command = self.fetch(state.stage, ball, 0.0)
        return Control(Fetching(state.stage, sought_ns, now_ns, state.far), command)

    def _retrieve(self, stage: Stage, belief: BallBelief, ball: BallTrack, far: bool) -> Control:
        c, s = math.cos(belief.pose.phi), math.sin(belief.pose.phi)
        stage, command = self.fetch(stage, ball, c * ball.vx + s * ball.vy)
        return Control(Fetching(stage, far=far), command)
