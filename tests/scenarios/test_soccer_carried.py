"""AGILO is carried to where its ball is wanted: the ball lies where it was, so nothing is achieved yet."""

from __future__ import annotations

import dataclasses
import math

import pytest

from tailor.executive import domains
from tailor.executive.deliberation.context import Settings, make_context
from tailor.executive.robot_models import load_models
from tailor.simnodes.world import Event, World
from tailor.tools.lockstep.bodies import body_of
from tailor.tools.lockstep.run import SENDER, run_lockstep

GOAL = "(and (final pos3) (atball pos3))"
FINAL = " (final pos3)"


def play(seed, events=(), goal=GOAL, final=FINAL):
    """Distance of the ball from its target at the end, m, and the episode."""
    scenario, start = domains.seeded_scenario("soccer", "approach-dribble", seed)
    scenario = dataclasses.replace(scenario, problem=scenario.problem.replace(GOAL, goal).replace(FINAL, final))
    target = scenario.places["pos3"]
    context = make_context(domains.load("soccer"), scenario, load_models("agilo"), Settings(), SENDER)
    world = World(body_of("soccer", ""), start, seed, [event(target) for event in events])
    episode = run_lockstep(context, world, limit_s=60.0)
    truth = episode.truth[-1]
    return math.dist((truth.ball_x, truth.ball_y), (target["x"], target["y"])), episode


def carried_at(time_s):
    def event(target):
        c, s = math.cos(target["phi"]), math.sin(target["phi"])
        place = {"x": target["x"] - 0.3 * c, "y": target["y"] - 0.3 * s, "phi": target["phi"]}
        return Event(time_s, {**place, "v": 0.0, "omega": 0.0})

    return event


@pytest.mark.parametrize(("seed", "time_s"), [(700000, 5.0), (700002, 3.5)])
def test_a_robot_carried_to_the_target_fetches_the_ball_that_it_had_before_it(seed, time_s):
    off_m, episode = play(seed, [carried_at(time_s)])
    assert "robot carried" in [finished.reason for finished in episode.finished]
    assert (episode.result, off_m < 0.4) == ("achieved", True)


@pytest.mark.parametrize("goal", ["(ball pos3)", "(atball pos3)", "(robot pos3)"])
def test_a_goal_that_names_only_the_place_of_ball_or_robot_is_reached_with_one_dribble(goal):
    off_m, episode = play(700001, goal=goal, final="")
    assert (episode.result, off_m < 0.4) == ("achieved", True)
    assert [finished.action for finished in episode.finished] == ["approachBall", "dribbleBall"]
