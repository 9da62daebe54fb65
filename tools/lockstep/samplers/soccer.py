"""Task sampler of the soccer robot (paper 5.1, 5.4): arguments, start states, beliefs, opponents."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tailor.executive.actions.planar import PHI, PHIG, VG, XG, YG, X, Y
from tailor.executive.belief.angles import difference
from tailor.executive.belief.ball_track import BallTrack
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.soccer import robot
from tailor.executive.domains.soccer.belief import FIRST_POSES, SoccerBelief, unknown
from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.values import Array
from tailor.schemas.messages import Message
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.tools.lockstep.samplers import opponents
from tailor.tools.lockstep.samplers.beside import Beside
from tailor.tools.lockstep.samplers.soccer_outcomes import SoccerOutcomes

MIN_BALL_DISTANCE_M = 0.50  # from the axle at the start: a nearer ball would be inside the robot
BELIEF_SIGMA_M = 0.02  # of a pose that has been tracked for a while
BELIEF_SIGMA_RAD = 0.015
BALL_SIGMA_M = 0.02
# Ends of 199 random approaches: gap between rail and ball 0.041 ± 0.014 m, ball aside ± 0.019 m
BALL_GAP_M = (0.015, 0.07)
ASIDE_SIGMA_M = 0.02
SHORT_SHARE, SHORT_M = 0.5, (0.3, 2.5)  # of the runs among opponents
LATEST = 1.0  # of a run: ticks up to its end, from which its rest is looked at
DRIBBLE_X_M = 2.5  # dribbles are sampled in the area of the scenarios
DRIBBLE_Y_M = 1.8
DRIBBLE_M = (0.4, 2.9)  # from the ball to its target; tasks begin with 1 m, but a kicked ball may lie nearer
DRIBBLE_ASIDE_RAD = 1.5  # between the target's heading and the line to it


@dataclass(frozen=True, slots=True)
class SoccerSampler(SoccerOutcomes):
    """See task_sampler.TaskSampler; controller arguments are (x, y, phi, v, xg, yg, phig, vg)."""

    def sample(self, action: Action, rng: np.random.Generator) -> Array:
        """Controller arguments, shape (8,), uniform over the action's ranges; impossible ones are rejected."""
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

    def sample_among_objects(self, action: Action, rng: np.random.Generator) -> Array:
        """Like `sample`, half of it short: ways around opponents are."""
        arguments = self.sample(action, rng)
        if rng.random() < SHORT_SHARE:
            distance, bearing = rng.uniform(*SHORT_M), rng.uniform(-math.pi, math.pi)
            for at, off, parameter in ((XG, math.cos(bearing), X), (YG, math.sin(bearing), Y)):
                limit = action.parameters[at].upper
                arguments[at] = min(limit, max(-limit, arguments[parameter] + distance * off))
        return arguments

    def beside(self, action: Action, truths: Sequence[Message], count: int, rng: np.random.Generator) -> list[Beside]:
        """Opponents beside a run, half of them beside its rest from some tick on."""
        states = [truth for truth in truths if isinstance(truth, SoccerGroundTruth)]
        ticks = [0 if k % 2 else int(rng.integers(max(1, round(LATEST * len(states))))) for k in range(count)]
        failure = action.context.failure if action.context is not None else ""
        drawn = []
        for tick in ticks:
            poses = opponents.poses_of(states[tick:])
            opponent = opponents.draw_beside(poses, rng)
            touched = opponents.clearances(poses, np.array([opponent[:2]])).min() < opponent[2]
            row = np.array(opponents.believed(opponent, poses[0], rng))
            drawn.append(Beside(tick, row, failure if touched else ""))
        return drawn

    def context(self, action: Action, arguments: Array, rng: np.random.Generator) -> Array:
        """An opponent near the straight way, as it is believed: x, y, radius."""
        ends = np.array([arguments[[X, Y, PHI]], arguments[[XG, YG, PHIG]]])
        way = ends[0] + np.linspace(0.0, 1.0, 50)[:, None] * (ends[1] - ends[0])
        return np.array(opponents.draw_beside(way, rng))

    def context_start(self, action: Action, row: Array, rng: np.random.Generator) -> dict[str, float]:
        """The opponent, off by what a robot errs that has looked for a second."""
        x, y, radius = opponents.believed((row[0], row[1], row[2]), row[:2] + opponents.TYPICAL_M, rng)
        return {"opponent1_x": x, "opponent1_y": y, "opponent1_radius": radius}

    def start(self, action: Action, arguments: Array, rng: np.random.Generator) -> dict[str, float]:
        """Start state of the body.

        goToPose has no ball. The ball of an approach lies at the goal. A dribble starts as approaches end: the ball
        lies where the arguments put it, and the robot stops short of it with a lateral error.
        """
        x, y, phi, v, xg, yg, phig, _ = arguments.tolist()
        if action.name == "dribbleBall":
            c, s = math.cos(phi), math.sin(phi)
            ball_x, ball_y = x + robot.IN_RAIL_M * c, y + robot.IN_RAIL_M * s
            gap, aside = _ball_before_rail(rng)
            behind = robot.IN_RAIL_M + gap
            x, y = ball_x - behind * c + aside * s, ball_y - behind * s - aside * c
        elif action.name == "goToPose":
            return {"x": x, "y": y, "phi": phi, "v": v}
        else:
            ball_x = xg + robot.BEHIND_BALL_M * math.cos(phig)
            ball_y = yg + robot.BEHIND_BALL_M * math.sin(phig)
        return {"x": x, "y": y, "phi": phi, "v": v, "ball_x": ball_x, "ball_y": ball_y}

    def belief(self, start: Mapping[str, float], rng: np.random.Generator) -> SoccerBelief:
        """Belief after some time of tracking: pose and ball with their usual errors."""
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
        """Training example: the arguments with the believed state in place of the start.

        The start of a dribble follows from the ball and the robot's heading, as in instantiation.
        """
        pose = belief.pose
        x, y = pose.x, pose.y
        if action.name == "dribbleBall" and (ball := belief.ball_xy) is not None:
            x = ball[0] - robot.IN_RAIL_M * math.cos(pose.phi)
            y = ball[1] - robot.IN_RAIL_M * math.sin(pose.phi)
        return [x, y, pose.phi, max(0.0, belief.v), *arguments[XG : VG + 1].tolist()]

    def _sensible(self, places: Array) -> bool:
        """Whether a dribble is like those of the scenarios."""
        dx, dy = places[XG] - places[X], places[YG] - places[Y]
        aside = abs(difference(places[PHIG], math.atan2(dy, dx)))
        return bool(DRIBBLE_M[0] <= math.hypot(dx, dy) <= DRIBBLE_M[1] and aside <= DRIBBLE_ASIDE_RAD)

    def _has_room(self, arguments: Array) -> bool:
        ball_x = arguments[XG] + robot.BEHIND_BALL_M * math.cos(arguments[PHIG])
        ball_y = arguments[YG] + robot.BEHIND_BALL_M * math.sin(arguments[PHIG])
        return math.hypot(ball_x - arguments[X], ball_y - arguments[Y]) > MIN_BALL_DISTANCE_M


def _ball_before_rail(rng: np.random.Generator) -> tuple[float, float]:
    """Gap between rail and ball, and how far the ball lies aside (m); it never overlaps a tip of the rail."""
    while True:
        gap, aside = rng.uniform(*BALL_GAP_M), ASIDE_SIGMA_M * rng.standard_normal()
        ahead = robot.IN_RAIL_M + gap - robot.RAIL_TIP_M[0]
        if math.hypot(ahead, robot.RAIL_TIP_M[1] - abs(aside)) > robot.BALL_AND_RAIL_M:
            return gap, aside
