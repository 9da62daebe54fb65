"""Soccer's predicates: the values that they give a label, and which of them hold now (paper 6.1)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from tailor.executive.domains.soccer import balls, robot
from tailor.executive.domains.soccer.action_library import AT_BALL_MPS
from tailor.executive.domains.soccer.belief import SoccerBelief
from tailor.executive.interfaces.domain import Conflict, LabelQuery, Scenario
from tailor.executive.interfaces.values import Fact, Interval

BEFORE_AHEAD_M = (0.15, 0.70)  # a ball there, in the robot's frame, is `atball`: dribbling can begin
BEFORE_LEFT_M = 0.25
ARRIVED_M = 0.35  # a ball within this of the target is there


def value(query: LabelQuery) -> Interval | None:
    """Range of a quantity of a label; see tailor.executive.interfaces.domain.Domain.value."""
    intersection: Interval | None = None
    for fact in (*query.holds, *query.achieved):
        interval = _interval_of(query, fact)
        if interval is not None:
            intersection = interval if intersection is None else _intersected(query, intersection, interval)
    return intersection


def _interval_of(query: LabelQuery, fact: Fact) -> Interval | None:
    """Range that one predicate gives the queried quantity; None if it gives none."""
    if fact[0] == "atball" and fact not in query.holds and query.quantity == "v":
        return Interval(0.0, AT_BALL_MPS)
    exact = _exact_values(query, fact).get(query.quantity)
    return None if exact is None else Interval(exact, exact)


def _exact_values(query: LabelQuery, fact: Fact) -> Mapping[str, float]:
    """Values by quantity that a predicate takes from the belief or from the scenario."""
    name, holding = fact[0], fact in query.holds
    if name == "robot" and holding:
        return _robot(query.belief)
    if name in ("ball", "atball", "robot") and not holding:
        return _target(query)
    if name == "ball":
        return _ball(balls.with_ball_of(query.belief, query.label, query.scenario.settings))
    if name == "atball":
        return {**_robot(query.belief), **_ball(balls.with_ball_before_robot(query.belief))}
    if name == "final":
        return {"v": 0.0, **query.scenario.places[query.label]}
    if name == "route" and fact[2] == query.label:
        return query.scenario.places[query.label]
    return {}


def _target(query: LabelQuery) -> dict[str, float]:
    """Where ball and robot count as being at the target, whether the goal names its heading and speed or not."""
    if query.label != query.scenario.settings.get("target_label"):
        return {}
    place = query.scenario.places[query.label]
    return {"x": place["x"], "y": place["y"]}


def _robot(belief: SoccerBelief) -> dict[str, float]:
    pose = belief.pose
    return {"x": pose.x, "y": pose.y, "phi": pose.phi, "v": max(0.0, min(robot.V_MAX_MPS, belief.v))}


def _ball(belief: SoccerBelief) -> dict[str, float]:
    seen = belief.ball_xy
    if seen is None:
        raise Conflict("the ball has not been seen")
    return {"x": seen[0], "y": seen[1]}


def _intersected(query: LabelQuery, a: Interval, b: Interval) -> Interval:
    lower, upper = max(a.lower, b.lower), min(a.upper, b.upper)
    if lower > upper:
        ranges = f"[{a.lower:g}, {a.upper:g}] and in [{b.lower:g}, {b.upper:g}]"
        raise Conflict(f"{query.quantity} of {query.label} cannot be in {ranges}")
    return Interval(lower, upper)


def anchor(belief: SoccerBelief, scenario: Scenario, remembered: frozenset[Fact]) -> frozenset[Fact]:
    """The abstract state of now; see tailor.executive.interfaces.domain.Domain.anchor.

    If a ball is in play, the places of balls and robot are observed in the belief; all other facts are remembered.
    Settings of the scenario: `robot_label`, `ball_label` and, with two balls, `ball2_label` name the places where they
    are unless robot and ball are together, or at the target.
    """
    if not balls.in_play(belief, scenario.settings):
        return remembered
    observed = set(_observed(belief, scenario))
    return frozenset(f for f in remembered if f[0] not in ("robot", "ball", "atball")) | observed


def _observed(belief: SoccerBelief, scenario: Scenario) -> Iterator[Fact]:
    """A ball is at the target only while the robot holds it: otherwise it is approached at its true place."""
    near = balls.with_ball_before_robot(belief)
    held = near.ball if before_ball(near) else None
    for label, ball in balls.in_play(belief, scenario.settings).items():
        if ball is held:
            together = _at_target(near, scenario) or label
            yield from (("ball", together), ("robot", together), ("atball", together))
        else:
            yield ("ball", label)
    if held is None:
        yield ("robot", str(scenario.settings["robot_label"]))


def before_ball(belief: SoccerBelief) -> bool:
    """Whether the ball lies right before the robot, in the rail or about to be."""
    ball = belief.ball
    near, far = BEFORE_AHEAD_M
    return ball is not None and near < ball.ahead < far and abs(ball.left) < BEFORE_LEFT_M


def _at_target(belief: SoccerBelief, scenario: Scenario) -> str | None:
    """The label of the target at which the ball lies."""
    seen = belief.ball_xy
    label = scenario.settings.get("target_label")
    if seen is None or label is None:
        return None
    place = scenario.places[label]
    return str(label) if math.dist(seen, (place["x"], place["y"])) < ARRIVED_M else None
