"""Which ball a place, a fact or an action means, where the soccer robot knows two."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from tailor.executive.actions.planar import PHIG, XG, YG
from tailor.executive.belief.ball_track import BallTrack
from tailor.executive.domains.soccer import robot
from tailor.executive.domains.soccer.belief import SoccerBelief
from tailor.executive.interfaces.action import Control, Controller
from tailor.executive.interfaces.values import Array

Point = tuple[float, float]
NAMES = ("ball2_x (m)", "ball2_y (m)", "ball2_sigma (m)")


def in_play(belief: SoccerBelief, settings: Mapping[str, Any]) -> dict[str, BallTrack]:
    """Balls seen so far, by the labels of their places in a scenario's settings."""
    named = {"ball_label": belief.ball, "ball2_label": belief.ball2}
    return {str(settings[name]): ball for name, ball in named.items() if name in settings and ball is not None}


def with_ball_of(belief: SoccerBelief, label: str, settings: Mapping[str, Any]) -> SoccerBelief:
    """The belief with the ball of a label as its first: one that bears no ball's name is where the robot has one."""
    if label == settings.get("ball2_label"):
        return _swapped(belief)
    return belief if label == settings.get("ball_label") else with_ball_before_robot(belief)


def with_nearer_ball(belief: SoccerBelief, place: Point) -> SoccerBelief:
    """The belief with that ball as its first which is nearer to a place (m, map frame)."""
    first, second = belief.ball_xy, belief.ball2_xy
    if second is None or (first is not None and math.dist(first, place) <= math.dist(second, place)):
        return belief
    return _swapped(belief)


def with_ball_before_robot(belief: SoccerBelief) -> SoccerBelief:
    """The belief with that ball as its first which is nearer to the bottom of the rail."""
    if belief.ball2 is None:
        return belief
    pose = belief.pose
    return with_nearer_ball(belief, _ahead(pose.x, pose.y, pose.phi, robot.IN_RAIL_M))


def approached(belief: SoccerBelief, arguments: Array) -> SoccerBelief:
    """The belief with that ball as its first behind which the goal lies."""
    x, y, phi = arguments[[XG, YG, PHIG]].tolist()
    return with_nearer_ball(belief, _ahead(x, y, phi, robot.BEHIND_BALL_M))


def dribbled(belief: SoccerBelief, arguments: Array) -> SoccerBelief:
    """The belief with the ball before the robot as its first."""
    return with_ball_before_robot(belief)


@dataclass(frozen=True, slots=True)
class WithItsBall:
    """A controller of one ball, given the one that its action is about."""

    controller: Controller
    choose: Callable[[SoccerBelief, Array], SoccerBelief]

    def __call__(self, state: Any, now_ns: int, belief: SoccerBelief, arguments: Array) -> Control:
        """See tailor.executive.interfaces.action.Controller."""
        chosen = belief if belief.ball2 is None else self.choose(belief, arguments)
        return self.controller(state, now_ns, chosen, arguments)


def values(belief: SoccerBelief) -> tuple[float, ...]:
    """Values of NAMES, none without a second ball."""
    ball, place = belief.ball2, belief.ball2_xy
    return () if ball is None or place is None else (*place, ball.variance**0.5)


def _swapped(belief: SoccerBelief) -> SoccerBelief:
    return replace(belief, ball=belief.ball2, ball2=belief.ball)


def _ahead(x: float, y: float, phi: float, distance_m: float) -> Point:
    return x + distance_m * math.cos(phi), y + distance_m * math.sin(phi)
