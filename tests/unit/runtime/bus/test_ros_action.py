"""The action of ROS 2 that pursues a goal: its states, results and cancellations, without a bus and an executive."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tailor.runtime.bus.ros_action import server
from tailor.runtime.bus.ros_action.goals import KEPT
from tailor.runtime.bus.ros_action.server import MAX_WAITING, GoalAction
from tailor.schemas.messages import ExecStatus
from tailor.schemas.ros2.action_messages import CancelCode, GoalState
from tailor.schemas.ros2.profiles import PLAIN
from tailor.schemas.services import DROP
from tests.support.ros2.action_client import ClientSession, cancel_request, result_request, send_request

ONE, TWO, NOBODY = b"1" * 16, b"2" * 16, bytes(16)
GOAL = "(visited a)"
MOVING = ExecStatus(5 * 10**9, 1, "EXECUTING", "", "line", GOAL, "", "slide", 2, 0.5, 3.0)
DONE = replace(MOVING, stamp_ns=9 * 10**9, mode="READY", result="achieved")


@pytest.fixture
def client():
    return ClientSession()


@pytest.fixture
def action(client):
    return GoalAction(client)


def sent(client, action, goal_id=ONE, goal=GOAL):
    """A goal that the executive accepts."""
    call = client.call("send_goal", send_request(goal_id, goal))
    request = action.receive()
    assert request.text == goal
    request.accept()
    assert call.response.accepted
    return call.response.stamp


def result(client, action, goal_id=ONE):
    call = client.call("get_result", result_request(goal_id))
    action.answer()
    return call


def cancelled(client, action, goal_id=ONE, stamp_ns=0):
    call = client.call("cancel_goal", cancel_request(goal_id, stamp_ns))
    return call, action.receive()


def test_a_goal_is_pursued_with_feedback_until_it_is_achieved(client, action):
    sent(client, action)
    assert client.states == {ONE: GoalState.EXECUTING}
    waits = [result(client, action) for _ in range(2)]
    action.report(MOVING)
    assert [each.responses for each in waits] == [[], []]
    ((goal_id, feedback),) = client.feedback
    assert (goal_id, feedback.mode, feedback.action, feedback.action_index) == (ONE, "EXECUTING", "slide", 2)
    assert (feedback.action_elapsed_s, feedback.action_predicted_s) == (0.5, 3.0)
    action.report(DONE)
    for each in (*waits, result(client, action)):
        assert (each.response.status, each.response.result.result) == (GoalState.SUCCEEDED, "achieved")
        assert each.response.result.duration_s == pytest.approx(4.0)
    action.report(DONE)
    assert len(client.feedback) == 2, "of a goal that has ended there is none"
    assert client.states == {ONE: GoalState.SUCCEEDED}


@pytest.mark.parametrize(
    ("end", "named"),
    [
        (
            {"result": "failed", "result_reason": "no plan", "result_detail": "dead end"},
            ("failed", "no plan", "dead end"),
        ),
        ({"mode": "FAULT", "reason": "repeated failure", "detail": "slide"}, ("fault", "repeated failure", "slide")),
        ({"result": "cancelled"}, ("cancelled", "", "")),  # by other people
        ({"goal": "(visited b)"}, ("replaced", "", "")),
    ],
)
def test_a_goal_that_ends_otherwise_is_aborted_with_the_cause(client, action, end, named):
    sent(client, action)
    action.report(MOVING)
    action.report(replace(MOVING, **end))
    response = result(client, action).response
    assert response.status == GoalState.ABORTED
    assert (response.result.result, response.result.reason, response.result.detail) == named


def test_a_goal_that_the_executive_refuses_is_aborted_with_the_cause(client, action):
    call = client.call("send_goal", send_request(ONE, "(bad"))
    action.receive().refuse("goal:1:1: this parenthesis is never closed")
    response = result(client, action).response
    assert (call.response.accepted, response.status, response.result.result) == (True, GoalState.ABORTED, "refused")
    assert response.result.detail == "goal:1:1: this parenthesis is never closed"
    action.report(MOVING)
    assert len(client._heard) == 2
    assert client.states == {ONE: GoalState.ABORTED}


def test_who_subscribes_late_hears_the_states_within_a_second(client, action):
    for tick in range(20):
        action.report(replace(MOVING, tick=tick))
    assert client.published_states == 0, "there is no goal"
    sent(client, action)
    for tick in range(20, 30):
        action.report(replace(MOVING, tick=tick))
    action.report(replace(DONE, tick=30))
    before = client.published_states
    for tick in range(31, 51):
        action.report(replace(DONE, tick=tick))
    assert client.published_states == before + 2
    assert client.states == {ONE: GoalState.SUCCEEDED}


def test_a_goal_that_is_sent_twice_is_rejected(client, action):
    sent(client, action)
    call = client.call("send_goal", send_request(ONE, GOAL))
    assert (action.receive(), call.response.accepted) == (None, False)


def test_the_goal_of_another_client_replaces_the_open_one(client, action):
    sent(client, action)
    action.report(MOVING)
    waits = result(client, action)
    sent(client, action, TWO)
    assert (waits.response.status, waits.response.result.result) == (GoalState.ABORTED, "replaced")
    action.report(MOVING)
    assert client.states == {ONE: GoalState.ABORTED, TWO: GoalState.EXECUTING}


@pytest.mark.parametrize("named", [ONE, NOBODY])
def test_a_client_cancels_its_goal_or_all(client, action, named):
    sent(client, action)
    action.report(MOVING)
    call, request = cancelled(client, action, named)
    assert (request.text, call.responses) == (DROP, [])
    request.accept(f"cancelled: {GOAL}")
    assert call.response.return_code == CancelCode.NONE
    assert [bytes(info.goal_id.uuid) for info in call.response.goals_canceling] == [ONE]
    assert client.states == {ONE: GoalState.CANCELING}
    action.report(replace(MOVING, result="cancelled"))
    assert result(client, action).response.status == GoalState.CANCELED


@pytest.mark.parametrize("year", [2026, 2040])
def test_goals_until_a_time_are_cancelled(client, action, monkeypatch, year):
    monkeypatch.setattr(server, "wall_ns", lambda: (year - 1970) * 31_556_952 * 10**9)
    stamp = sent(client, action)
    stamp_ns = stamp.sec * 10**9 + stamp.nanosec
    for goal_id in (NOBODY, TWO):
        call, request = cancelled(client, action, goal_id, stamp_ns - 1)
        assert (request, len(call.response.goals_canceling)) == (None, 0)
        assert call.response.return_code == CancelCode.NONE, "so does rcl_action: none is as old as that"
        assert cancelled(client, action, goal_id, stamp_ns)[1].text == DROP


def test_what_cannot_be_cancelled_is_named(client, action):
    assert cancelled(client, action, NOBODY)[0].response.return_code == CancelCode.NONE
    assert cancelled(client, action, ONE)[0].response.return_code == CancelCode.UNKNOWN_GOAL_ID
    sent(client, action)
    call, request = cancelled(client, action)
    request.refuse("no")
    assert call.response.return_code == CancelCode.REJECTED
    action.report(DONE)
    assert cancelled(client, action)[0].response.return_code == CancelCode.GOAL_TERMINATED


@pytest.mark.parametrize("before", [replace(MOVING, goal="", mode="READY"), DONE, replace(DONE, result="failed")])
def test_a_goal_without_conditions_ends_at_once_whatever_became_of_the_one_before(client, action, before):
    client.call("send_goal", send_request(ONE, "(and)"))
    action.receive().accept("no goal is open")
    action.report(before)
    response = result(client, action).response
    assert (response.status, response.result.result) == (GoalState.ABORTED, "cancelled")
    assert response.result.detail == "no goal is open"


def test_a_goal_without_conditions_drops_the_open_one(client, action):
    sent(client, action)
    action.report(MOVING)
    waits = result(client, action)
    client.call("send_goal", send_request(TWO, "(and)"))
    action.receive().accept(f"cancelled: {GOAL}")
    action.report(replace(MOVING, mode="READY", result="cancelled"))
    assert (waits.response.status, waits.response.result.result) == (GoalState.ABORTED, "cancelled")
    assert client.states == {ONE: GoalState.ABORTED, TWO: GoalState.ABORTED}


def test_who_waits_is_answered_when_the_executive_ends(client, action):
    sent(client, action)
    waits = result(client, action)
    action.close()
    assert (waits.response.status, waits.response.result.result) == (GoalState.ABORTED, "stopped")


def test_a_request_that_comes_as_the_executive_ends_is_answered(client, action):
    sent(client, action)
    call = client.call("get_result", result_request(ONE))
    action.close()
    assert call.response.result.result == "stopped"


def test_an_unknown_goal_has_no_result(client, action):
    response = result(client, action).response
    assert (response.status, response.result.result) == (GoalState.UNKNOWN, "")


def test_the_memory_of_goals_and_of_who_waits_is_bounded(client, action):
    for number in range(2 * KEPT):
        sent(client, action, number.to_bytes(16, "big"))
    assert len(client.states) == KEPT + 1
    newest = (2 * KEPT - 1).to_bytes(16, "big")
    calls = [result(client, action, newest) for _ in range(MAX_WAITING + 1)]
    assert [len(call.responses) for call in calls] == [1] + [0] * MAX_WAITING, "the oldest may be of clients that died"
    assert calls[0].response.status == GoalState.EXECUTING


@pytest.mark.parametrize("replaced", [False, True])
def test_a_goal_that_was_open_while_others_were_refused_is_known_when_it_has_ended(client, action, replaced):
    sent(client, action)
    action.report(MOVING)
    for number in range(2 * KEPT):
        client.call("send_goal", send_request(number.to_bytes(16, "big"), "(bad"))
        action.receive().refuse("no")
    waits = result(client, action)
    if replaced:
        sent(client, action, TWO)
    else:
        action.report(DONE)
        client.call("send_goal", send_request(TWO, "(bad"))
        action.receive().refuse("no")
    for each in (waits, result(client, action)):
        assert each.response.result.result == ("replaced" if replaced else "achieved")


@given(st.sampled_from(["send_goal", "cancel_goal", "get_result"]), st.binary(max_size=64), st.booleans())
def test_whatever_bytes_come_are_answered_once(part, data, opened):
    client = ClientSession()
    action = GoalAction(client)
    if opened:
        sent(client, action)
    call = client.call(part, data)
    request = action.receive()
    action.answer()
    if request is not None:
        request.accept()
    assert len(call.responses) == 1


def test_a_session_without_ros_declares_nothing():
    client = ClientSession()
    client.keys = PLAIN
    action = GoalAction(client)
    action.report(MOVING)
    action.close()
    assert (action.receive(), client.waiting) == (None, {})
