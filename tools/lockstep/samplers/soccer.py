"""Trials of the soccer robot's actions (paper 5.1, 5.4): starts, beliefs, and the ball that gets in the way."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from tailor.executive.actions.planar import PHIG, VG, XG, YG, X, Y
from tailor.executive.belief.angles import difference
from tailor.executive.belief.ball_track import BallTrack
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.soccer import robot
from tailor.executive.domains.soccer.belief import FIRST_POSES, SoccerBelief, unknown
from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.values import Array
from tailor.schemas.messages import Message
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.tools.lockstep.samplers.drive_work import wheel_work_j

COLLIDED_M = 0.05  # an approach that displaces the ball by more before the goal state has failed
ROOM_M = 0.50  # from the axle to the ball at the start: nearer the ball would be inside the robot
BELIEF_SIGMA_M = 0.02  # of a pose that has been tracked for a while
BELIEF_SIGMA_RAD = 0.015
BALL_SIGMA_M = 0.02
SHORT_M = (0.05, 0.15)  # how far from the rail the ball is when an approach has ended
ASIDE_SIGMA_M = 0.04
DRIBBLE_X_M = 2.5  # dribbles are sampled where scenarios have them
DRIBBLE_Y_M = 1.8
DRIBBLE_M = (0.9, 2.9)  # from the ball to its target
DRIBBLE_ASIDE_RAD = 1.5  # the target's heading off the line to it


@dataclass(frozen=True, slots=True)
class SoccerSampler:
    """See tailor.tools.lockstep.action_run.Trials; controller arguments are (x, y, phi, v, xg, yg, phig, vg)."""

    def sample(self, action: Action, rng: np.random.Generator) -> Array:
        """Controller arguments, shape (8,), uniform over the action's ranges but for what cannot be."""
        lower = np.array([p.lower for p in action.parameters])
        upper = np.array([p.upper for p in action.parameters])
        dribble = action.name == "dribbleBall"
        if dribble:
            for at, limit in ((X, DRIBBLE_X_M), (Y, DRIBBLE_Y_M), (XG, DRIBBLE_X_M), (YG, DRIBBLE_Y_M)):
                lower[at], upper[at] = -limit, limit
        while True:
            places = rng.uniform(lower, upper)
            arguments: Array = action.arguments(places[None, :])[0]
            if self._sensible(places) if dribble else self._has_room(arguments):
                return arguments

    def start(self, action: Action, arguments: Array, rng: np.random.Generator) -> dict[str, float]:
        """Start state of the body.

        goToPose has no ball. An approach has it where it would be at the goal. A dribble begins as approaches end: the
        ball rests where the arguments put it, and the robot is still short of it, not quite facing it.
        """
        x, y, phi, v, xg, yg, phig, _ = arguments.tolist()
        if action.name == "dribbleBall":
            c, s = math.cos(phi), math.sin(phi)
            ball_x, ball_y = x + robot.IN_RAIL_M * c, y + robot.IN_RAIL_M * s
            behind, aside = robot.IN_RAIL_M + rng.uniform(*SHORT_M), ASIDE_SIGMA_M * rng.standard_normal()
            x, y = ball_x - behind * c + aside * s, ball_y - behind * s - aside * c
        elif action.name == "goToPose":
            return {"x": x, "y": y, "phi": phi, "v": v}
        else:
            ball_x = xg + robot.BEHIND_BALL_M * math.cos(phig)
            ball_y = yg + robot.BEHIND_BALL_M * math.sin(phig)
        return {"x": x, "y": y, "phi": phi, "v": v, "ball_x": ball_x, "ball_y": ball_y}

    def belief(self, start: Mapping[str, float], rng: np.random.Generator) -> SoccerBelief:
        """What the robot would believe had it been on its way for a while."""
        off = rng.standard_normal(5)
        pose = Pose(
            start["x"] + BELIEF_SIGMA_M * off[0],
            start["y"] + BELIEF_SIGMA_M * off[1],
            start["phi"] + BELIEF_SIGMA_RAD * off[2],
            (BELIEF_SIGMA_M**2, 0.0, 0.0, BELIEF_SIGMA_M**2, 0.0, BELIEF_SIGMA_RAD**2),
        )
        believed = replace(unknown(), pose=pose, v=start["v"], poses_seen=FIRST_POSES)
        if "ball_x" not in start:
            return believed
        c, s = math.cos(start["phi"]), math.sin(start["phi"])
        dx, dy = start["ball_x"] - start["x"], start["ball_y"] - start["y"]
        sigma = min(BALL_SIGMA_M, 0.05 * math.hypot(dx, dy))
        ball = BallTrack(c * dx + s * dy + sigma * off[3], c * dy - s * dx + sigma * off[4], 0.0, 0.0, sigma**2, 0)
        return replace(believed, ball=ball)

    def arguments_now(self, action: Action, belief: SoccerBelief, arguments: Array) -> list[float]:
        """The controller arguments with the believed state in place of the start: an example to learn from.

        The start of a dribble is told by the ball and the robot's heading, as instantiation tells it.
        """
        pose = belief.pose
        x, y = pose.x, pose.y
        if action.name == "dribbleBall" and belief.ball_xy is not None:
            x = belief.ball_xy[0] - robot.IN_RAIL_M * math.cos(pose.phi)
            y = belief.ball_xy[1] - robot.IN_RAIL_M * math.sin(pose.phi)
        return [x, y, pose.phi, max(0.0, belief.v), *arguments[XG : VG + 1].tolist()]

    def work_j(self, before: Message, after: Message) -> float:
        """Joules that the wheels have taken between two states."""
        return wheel_work_j(before, after)

    def failure(self, action: Action, start: Mapping[str, float], truth: SoccerGroundTruth) -> str:
        """What has gone wrong in the world by now, or ""; an approach fails when the ball is knocked away."""
        if action.name != "approachBall":
            return ""
        moved = math.hypot(truth.ball_x - start["ball_x"], truth.ball_y - start["ball_y"])
        return "collision" if moved > COLLIDED_M else ""

    def _sensible(self, places: Array) -> bool:
        """Whether a dribble is of the kind that scenarios ask for."""
        dx, dy = places[XG] - places[X], places[YG] - places[Y]
        aside = abs(difference(places[PHIG], math.atan2(dy, dx)))
        return bool(DRIBBLE_M[0] <= math.hypot(dx, dy) <= DRIBBLE_M[1] and aside <= DRIBBLE_ASIDE_RAD)

    def _has_room(self, arguments: Array) -> bool:
        ball_x = arguments[XG] + robot.BEHIND_BALL_M * math.cos(arguments[PHIG])
        ball_y = arguments[YG] + robot.BEHIND_BALL_M * math.sin(arguments[PHIG])
        return math.hypot(ball_x - arguments[X], ball_y - arguments[Y]) > ROOM_M
