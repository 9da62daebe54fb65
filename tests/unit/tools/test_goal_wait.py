"""Who waits for a goal reads what became of that goal, never of the one before, and learns when nobody tells."""

from dataclasses import replace

import pytest

from tailor.schemas.messages import ExecStatus, Sample
from tailor.schemas.ros2.action_messages import GoalResult
from tailor.tools.operator.goal_wait import SILENT_S, GoalWait

OURS, OTHER = "ab" * 16, "cd" * 16
MOVING = ExecStatus(10**9, 7, "EXECUTING", "", "line", "(visited a)", "", "slide", 0, 0.5, 3.0)


def sample(sender=OURS, **changed):
    return Sample("exec/status", replace(MOVING, **changed), 0, 1, sender)


@pytest.fixture
def wait():
    """Accepted in tick 7, at 100 s."""
    waiting = GoalWait("(visited a)")
    waiting.hear(sample(tick=6, goal="(visited b)", result="achieved"), 99.9)
    waiting.accept(100.0)
    return waiting


def test_a_goal_is_followed_to_its_end(wait):
    wait.hear(sample(), 100.1)
    assert (wait.result, wait.line) == (None, "EXECUTING slide")
    wait.hear(sample(tick=8, mode="DISARMED", action="", reason="driver not armed", detail="estopped"), 100.2)
    assert (wait.result, wait.line) == (None, "DISARMED: driver not armed: estopped")
    failed = {"result": "failed", "result_reason": "unsolvable", "result_detail": "dead end"}
    wait.hear(sample(tick=30, stamp_ns=3 * 10**9, mode="READY", **failed), 102.4)
    assert wait.result == GoalResult("failed", "unsolvable", "dead end", 2.0)
    wait.hear(sample(tick=31, goal="(visited b)"), 102.5)
    assert wait.result.result == "failed", "it has ended"


def test_a_status_of_a_tick_before_the_acceptance_tells_nothing(wait):
    wait.hear(sample(tick=6, result="achieved"), 100.05)
    assert (wait.result, wait.line) == (None, "")


def test_a_goal_that_is_done_in_its_first_tick_is_achieved(wait):
    wait.hear(sample(mode="READY", result="achieved"), 100.1)
    assert wait.result == GoalResult("achieved")


def test_a_goal_that_was_replaced_before_its_first_status_was_heard_is_told_from_the_next_one():
    waiting = GoalWait("(visited a)")
    waiting.hear(sample(tick=7), 100.3)  # of the acceptance, read late, as is that of tick 8
    waiting.accept(100.3)
    waiting.hear(sample(tick=9, goal="(visited b)", result="achieved"), 100.4)
    assert waiting.result.result == "replaced"


def test_the_goal_of_the_scenario_is_known_from_the_first_status():
    waiting = GoalWait()
    waiting.accept(100.0)
    waiting.hear(sample(), 100.1)
    waiting.hear(sample(tick=8, goal="(visited b)"), 100.2)
    assert waiting.result.result == "replaced"


def test_another_executive_tells_nothing_about_it(wait):
    wait.hear(sample(), 100.1)
    wait.hear(sample(OTHER, tick=99, result="achieved"), 100.2)
    assert wait.result is None


def test_an_executive_that_is_silent_or_was_started_again_is_lost(wait):
    wait.hear(sample(), 101.0)
    assert not wait.lost(101.0 + SILENT_S)
    wait.hear(sample(OTHER, tick=1), 103.0)
    assert wait.lost(101.1 + SILENT_S)


@pytest.mark.parametrize("goal", ["(visited a)", ""])
def test_another_executive_is_followed_that_pursues_the_goal_as_the_known_one_has_ended(goal):
    """It was told to be silent, where one ended between its last status and the goal, and the next one answered."""
    wait = GoalWait(goal)
    wait.hear(sample(tick=6, goal="(visited b)"), 99.9)
    wait.accept(100.0)
    wait.hear(sample(OTHER, tick=1), 100.1)
    assert wait.line == "", "the known one may come later"
    for other in ({"goal": ""}, {"goal": "(visited a)", "result": "achieved"}):
        wait.hear(sample(OTHER, tick=2, **other), 101.1)
        assert (wait.result, wait.line) == (None, "")
    wait.hear(sample(OTHER, tick=3), 101.2)
    assert wait.line == "EXECUTING slide"
    wait.hear(sample(tick=7, result="achieved"), 101.3)
    assert wait.result is None
    wait.hear(sample(OTHER, tick=4, result="achieved"), 101.4)
    assert wait.result.result == "achieved"


def test_nobody_is_lost_before_the_acceptance_or_after_the_end(wait):
    assert not GoalWait().lost(1000.0)
    wait.hear(sample(result="achieved"), 100.1)
    assert not wait.lost(1000.0)
