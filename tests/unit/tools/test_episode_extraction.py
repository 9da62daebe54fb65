"""Episodes cut out of what an executive said: where they begin, what they ask for, how they ended."""

from dataclasses import replace

import numpy as np

from tailor.executive import domains
from tailor.executive.interfaces.action import Parameter as ActionParameter
from tailor.models.episodes.episodes import UNOBSERVED
from tailor.schemas.messages import (
    ActionFinished,
    ActionObjects,
    Contexts,
    ExecStatus,
    InstantiatedAction,
    Parameter,
    Subgoals,
)
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.tools.lockstep.episode_extraction import EpisodeExtractor

DOMAIN = domains.load("soccer")
START = {"x": 0.0, "y": 0.0, "phi": 0.0, "v": 0.0}


def subgoals(action: str, goal: dict[str, float], step: int = 1) -> Subgoals:
    values = {**START, **goal}
    parameters = tuple(
        Parameter(p.name, k, "p", p.unit, True, p.lower, p.upper, values.get(p.name, 0.0))
        for k, p in enumerate(DOMAIN.actions[action].parameters)
    )
    return Subgoals(0, 0, 2, (InstantiatedAction(action, step, False, 3.0, 0.1, parameters),))


def status(action: str, index: int, elapsed_s: float, x: float) -> ExecStatus:
    belief = (x, 0.5, 0.1, 0.2, 0.0, 1.0, 0.0, 0.01, 0.01)
    return ExecStatus(0, 0, "EXECUTING", "", "s", "g", "", action, index, elapsed_s, 3.0, belief)


def finished(action: str, index: int, seconds: float, outcome: str = "done") -> ActionFinished:
    return ActionFinished(0, 0, action, index, outcome, "" if outcome == "done" else "lost", 3.0, seconds)


def truth(ball_x: float) -> SoccerGroundTruth:
    return SoccerGroundTruth(0, 0.0, 0.0, 0.0, 0.0, 0.0, ball_x, 0.0, 0.0, 0.0)


def drive(action: str, index: int, ticks: int, first: int = 0) -> list[ExecStatus]:
    return [status(action, index, 0.1 * k, 0.01 * k) for k in range(first, first + ticks)]


def cut(*messages):
    return EpisodeExtractor(DOMAIN).read(messages)


def test_an_action_becomes_an_episode_with_the_believed_states() -> None:
    said = cut(subgoals("goToPose", {"xg": 2.0, "vg": 0.3}), *drive("goToPose", 0, 30), finished("goToPose", 0, 3.0))
    [(name, episode)] = said
    assert name == "goToPose"
    assert episode.duration_s == 3.0
    assert episode.failure == UNOBSERVED  # a move to a waypoint says nothing about balls
    assert np.allclose(episode.ticks[:, 0], 0.01 * np.arange(30))
    assert np.allclose(episode.ticks[:, [4, 7]], [2.0, 0.3])


def test_an_episode_knows_whether_it_was_decided_beside_objects() -> None:
    goal, ticks, end = subgoals("goToPose", {"xg": 2.0}), drive("goToPose", 0, 10), finished("goToPose", 0, 1.0)
    there, gone = (ActionObjects("goToPose", ("x", "y", "r"), row) for row in ((1.0, 0.0, 0.2), ()))
    other = replace(there, action="approachBall")
    for objects, expected in (((there,), True), ((gone,), False), ((other,), False)):
        [(_, episode)] = cut(Contexts(0, goal.tick, objects), goal, *ticks, end)
        assert episode.in_context is expected
    [(_, episode)] = cut(Contexts(0, goal.tick, (there,)), replace(goal, tick=7), *ticks, end)
    assert not episode.in_context, "objects of an older decision"


def test_a_decision_beside_objects_begins_an_episode_in_context() -> None:
    first, late = drive("goToPose", 0, 10), drive("goToPose", 0, 10, first=10)
    there = Contexts(0, 9, (ActionObjects("goToPose", ("x", "y", "r"), (1.0, 0.0, 0.2)),))
    anew = replace(subgoals("goToPose", {"xg": 2.5}), tick=9)
    messages = (subgoals("goToPose", {"xg": 2.0}), *first, there, anew, *late, finished("goToPose", 0, 2.0))
    [(_, episode)] = cut(*messages)
    assert episode.in_context


def test_an_approach_s_goal_is_behind_the_ball() -> None:
    messages = subgoals("approachBall", {"xg": 2.0}), *drive("approachBall", 0, 30)
    [(name, episode)] = cut(*messages, finished("approachBall", 0, 3.0))
    assert name == "approachBall"
    assert 1.5 < episode.ticks[0, 4] < 1.8


def test_a_ball_that_was_knocked_away_makes_an_approach_fail() -> None:
    before, after = drive("approachBall", 0, 5), drive("approachBall", 0, 5, first=5)
    for moved, failure in ((0.02, ""), (0.08, "collision")):
        messages = (subgoals("approachBall", {"xg": 2.0}), *before, truth(1.0), *after, truth(1.0 + moved))
        [(_, episode)] = cut(*messages, finished("approachBall", 0, 1.0))
        assert episode.failure == failure
        assert episode.success is (failure == "")


def test_a_changed_goal_begins_a_new_episode_and_a_next_action_s_goal_does_not() -> None:
    first, late = drive("goToPose", 0, 10), drive("goToPose", 0, 10, first=10)
    better, other = subgoals("goToPose", {"xg": 2.5}), subgoals("goToPose", {"xg": -1.0}, step=2)
    messages = (subgoals("goToPose", {"xg": 2.0}), *first, better, *late, other, finished("goToPose", 0, 2.0))
    [(_, episode)] = cut(*messages)
    assert len(episode.ticks) == 10
    assert np.isclose(episode.duration_s, 1.0)
    assert episode.arguments[4] == 2.5


def test_what_failed_before_its_goal_changed_failed_with_the_former_goal() -> None:
    first, late = drive("approachBall", 0, 10), drive("approachBall", 0, 10, first=10)
    knocked = subgoals("approachBall", {"xg": 2.0}), *first[:5], truth(2.0), *first[5:], truth(2.5)
    again = subgoals("approachBall", {"xg": 2.5}), *late[:5], truth(2.5), *late[5:]
    messages = *knocked, *again, finished("approachBall", 0, 2.0)
    [(_, failed), (_, fetched)] = cut(*messages)
    assert (failed.finished, failed.success, failed.failure) == (False, False, "collision")
    assert np.isclose(failed.duration_s, 1.0)
    assert fetched.arguments[4] - failed.arguments[4] == 0.5
    assert (fetched.finished, fetched.success, fetched.failure) == (True, True, "")


def test_an_action_that_goes_on_in_a_new_plan_begins_a_new_episode() -> None:
    """The plan may number its step otherwise; the index of the action stays."""
    first, late = drive("goToPose", 0, 10), drive("goToPose", 0, 10, first=10)
    messages = (subgoals("goToPose", {"xg": 2.0}), *first, subgoals("goToPose", {"xg": 2.5}, step=2), *late)
    [(_, episode)] = cut(*messages, finished("goToPose", 0, 2.0))
    assert len(episode.ticks) == 10
    assert episode.arguments[4] == 2.5


def test_what_was_aborted_is_no_episode_and_what_failed_is_not_finished() -> None:
    begun = subgoals("dribbleBall", {"xg": 2.0}), *drive("dribbleBall", 0, 10)
    assert cut(*begun, finished("dribbleBall", 0, 1.0, "aborted")) == []
    [(name, episode)] = cut(*begun, finished("dribbleBall", 0, 1.0, "failed"))
    assert name == "dribbleBall"
    assert (episode.finished, episode.success, episode.failure) == (False, False, "lost")


def test_a_dribble_starts_where_the_ball_is() -> None:
    [(_, episode)] = cut(
        subgoals("dribbleBall", {"xg": 2.0}), *drive("dribbleBall", 0, 5), finished("dribbleBall", 0, 0.5)
    )
    believed_ball = np.array([1.0, 0.0])
    reach = np.linalg.norm(believed_ball - episode.ticks[0, :2])
    assert 0.2 < reach < 0.4  # from the axle to a ball in the rail


def test_the_work_of_the_drives_is_cut_with_the_episode_where_motion_is_told() -> None:
    def moving(k: int) -> SoccerGroundTruth:
        return SoccerGroundTruth(k * 100_000_000, 0.0, 0.0, 0.0, 0.1 * k, 0.0, 1.0, 0.0, 0.0, 0.0)

    ticks = [message for k, said in enumerate(drive("goToPose", 0, 5)) for message in (moving(k), said)]
    [(_, told)] = cut(subgoals("goToPose", {"xg": 2.0}), *ticks, finished("goToPose", 0, 0.5))
    assert told.work_j is not None
    assert len(told.work_j) == len(told.ticks)
    assert told.work_j[-1] == 0.0
    assert (np.diff(told.work_j[:-1]) > 0).all()
    [(_, untold)] = cut(subgoals("goToPose", {"xg": 2.0}), *drive("goToPose", 0, 5), finished("goToPose", 0, 0.5))
    assert untold.work_j is None


def test_a_start_with_more_values_than_the_goal_is_believed_at_each_tick() -> None:
    swirl, plain = ActionParameter("omega", 0, "omega", "rad/s", -2.0, 2.0), DOMAIN.actions["goToPose"]
    turning = replace(DOMAIN, actions={"goToPose": replace(plain, parameters=(*plain.parameters, swirl))})
    chosen = subgoals("goToPose", {"xg": 2.0}).actions[0]
    chosen = replace(chosen, parameters=(*chosen.parameters, Parameter("omega", 8, "p", "rad/s", True, -2.0, 2.0, 0.0)))
    turns = [replace(each, belief=(0.0, 0.0, 0.0, 0.0, 0.1 * k)) for k, each in enumerate(drive("goToPose", 0, 10))]
    run = [Subgoals(0, 0, 2, (chosen,)), *turns, finished("goToPose", 0, 1.0)]
    [(_, episode)] = EpisodeExtractor(turning).read(run)
    assert np.allclose(episode.ticks[:, 8], 0.1 * np.arange(10))
    assert np.allclose(episode.ticks[:, 4], 2.0)


def test_a_reach_of_an_arm_keeps_the_spot_that_is_no_state_of_the_robot() -> None:
    """The kitchen's: on-policy rounds of its recipe broke off here."""
    kitchen = domains.load("kitchen")
    chosen = {"x": 0.0, "y": 0.0, "phi": 0.0, "spot_x": 0.7, "spot_y": 0.1, "aside": 0.2}
    parameters = tuple(
        Parameter(p.name, k, "left1", p.unit, True, p.lower, p.upper, chosen[p.name])
        for k, p in enumerate(kitchen.actions["reach"].parameters)
    )
    instance = Subgoals(0, 0, 2, (InstantiatedAction("reach", 1, False, 3.0, 0.1, parameters),))
    ticks = [replace(each, belief=(0.03, 0.5, 0.1)) for each in drive("reach", 0, 25)]
    [(name, episode)] = EpisodeExtractor(kitchen).read([instance, *ticks, finished("reach", 0, 2.5)])
    assert (name, episode.duration_s) == ("reach", 2.5)
    assert np.allclose(episode.ticks[-1], [0.03, 0.5, 0.1, 0.7, 0.1, 0.2])
