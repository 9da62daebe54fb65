"""The live shell: around a core whose robot's code raises in the midst of a run, and with a client of ROS 2."""

import dataclasses
import re

import pytest

from tailor.executive.shell import Shell
from tailor.runtime.bus.service import ServiceRequest, ServiceServer
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import TickReport, VelocityCommand
from tailor.schemas.ros2.action_messages import GoalState
from tailor.schemas.ros2.profiles import PLAIN
from tests.support.ros2.action_client import ClientSession, cancel_request, result_request, send_request
from tests.support.toy_domain import SLIDE, driver, line_context, odometry


class Clock:
    """Time passes only while somebody waits."""

    def __init__(self):
        self.ns = 10**9

    def now_ns(self):
        return self.ns

    def sleep_until(self, until_ns):
        self.ns = until_ns


class Session:
    """A bus on which a driver obeys, and the robot stands at 0; keeps what is published."""

    keys = PLAIN

    def __init__(self):
        self.published, self._tick = [], 0

    def inbox(self, topics, robot):
        return self

    def drain(self, now_ns):
        self._tick += 1
        return odometry(now_ns, 0.0, self._tick), driver(now_ns)

    def service_server(self, key, *others):
        return ServiceServer(self, *others)

    def receive(self):
        return None

    def publisher(self, topic, robot):
        return Publisher(self.published)


class Publisher:
    def __init__(self, published):
        self.publish = published.append


@pytest.mark.parametrize(
    ("breaking", "raised"),
    [(lambda: {}["wheel"], (KeyError, "wheel")), (lambda: None, (UsageError, "slide returned None"))],
)
def test_a_robot_whose_code_raises_or_returns_nothing_in_a_tick_brakes_at_once(breaking, raised):
    context, calls = line_context(), []

    def breaks(state, now_ns, belief, arguments):
        calls.append(now_ns)
        return SLIDE.controller(state, now_ns, belief, arguments) if len(calls) < 4 else breaking()

    context.domain.actions = {"slide": dataclasses.replace(SLIDE, controller=breaks)}
    session = Session()
    shell = Shell(context, session, Clock(), {})
    with pytest.raises(raised[0], match=raised[1]):
        shell.run(context.problem.goal_text, lambda state: False)
    commands = [message.v for message in session.published if isinstance(message, VelocityCommand)]
    assert commands[-2] > 0.1
    assert commands[-1] == 0.0
    *_, last = session.published
    ticks = [message for message in session.published if isinstance(message, TickReport)]
    assert last.stamp_ns > ticks[-1].stamp_ns, "it belongs to the tick that has no report"


def test_what_raises_again_while_the_robot_is_brought_to_rest_hides_nothing():
    context = line_context()

    def lost(command, stamp_ns):
        raise OSError("lost")

    shell = Shell(context, Session(), Clock(), {})
    context.domain.message = lost
    with pytest.raises(OSError, match="lost"):
        shell.run(context.problem.goal_text, lambda state: False)


def test_refused_fields_of_inputs_are_named_by_key():
    session = Session()
    session.refused_fields = {}
    shell = Shell(line_context(), session, Clock(), {})
    assert shell.refused_fields == ""
    session.refused_fields |= {"b/pose": "not finite (x)", "a/odom": "not finite (y)"}
    assert shell.refused_fields == "a/odom refused: not finite (y); b/pose refused: not finite (x)"


class Goals(Session):
    """A bus on which requests for goals wait; keeps the answers."""

    def __init__(self, clock, requests):
        super().__init__()
        self.clock, self.requests, self.answers = clock, requests, []

    def receive(self):
        at_ns = min(self.requests, default=None)
        if at_ns is None or self.clock.ns < at_ns:
            return None
        return ServiceRequest(self.requests.pop(at_ns), lambda *answer: self.answers.append(answer))


class PausedClock(Clock):
    """A clock of a process that is stopped while it waits for its eleventh period."""

    def __init__(self, pause_s):
        super().__init__()
        self.waits, self.pause_s = 0, pause_s

    def sleep_until(self, until_ns):
        self.waits += 1
        self.ns = until_ns + round(self.pause_s * 1e9) * (self.waits == 10)


def answer_after(pause_s, goal, delay_s=0.05, waits=False):
    """The answer to a goal that waits while the executive stands still, in a tick or between two, and its goal then."""
    clock = PausedClock(pause_s if waits else 0.0)
    session = Goals(clock, {clock.ns + round((1.0 + pause_s + delay_s) * 1e9): goal})
    shell = Shell(line_context(), session, clock, {})

    def until(state):
        if state.tick == 10 and not waits:
            clock.ns += round(pause_s * 1e9)
        return bool(session.answers)

    state = shell.run("", until)
    return session.answers[0], state.task.goal


@pytest.mark.promise("P41")
@pytest.mark.parametrize("waits", [False, True])
def test_a_goal_that_waited_while_the_executive_stood_still_is_refused(waits):
    (accepted, text), goal = answer_after(12.0, "(visited a)", -0.2, waits=waits)
    assert (accepted, goal) == (False, "")
    assert re.fullmatch(r"the executive stood still for 1[12]\.\d s; send the goal again if it holds", text)
    (accepted, _), goal = answer_after(0.8, "(visited a)", -0.2, waits=waits)
    assert (accepted, goal) == (False, ""), "the bus takes a process for gone by then"
    (accepted, _), goal = answer_after(12.0, "(visited a)", delay_s=0.8, waits=waits)
    assert (accepted, goal) == (False, ""), "the bus delivers it a little later"


@pytest.mark.parametrize(("pause_s", "delay_s", "goal"), [(0.5, 0.05, "(visited a)"), (12.0, 1.5, "(visited a)")])
def test_a_goal_after_a_short_pause_or_later_counts(pause_s, delay_s, goal):
    assert answer_after(pause_s, goal, delay_s) == ((True, "accepted"), goal)


def test_dropping_the_goal_counts_also_after_a_pause():
    assert answer_after(12.0, "(and)")[0] == (True, "no goal is open")


@pytest.mark.parametrize(
    ("goal", "answer"), [("(visited a)", (False, "the executive ends")), ("(and)", (True, "no goal is open"))]
)
def test_a_goal_that_comes_as_the_executive_ends_is_refused(goal, answer):
    """It was accepted, and nobody pursued it."""
    clock = Clock()
    session = Goals(clock, {})

    def until(state):
        if state.tick == 5:
            session.requests[clock.ns] = goal
        return state.tick == 5

    Shell(line_context(), session, clock, {}).run("", until)
    assert session.answers == [answer]


class RosSession(ClientSession, Session):
    """The same bus with a client of ROS 2's action."""

    def __init__(self):
        ClientSession.__init__(self)
        Session.__init__(self)


def results_of(goals, then=()):
    """Send each goal by the action in its tick, cancel in others; states and results at the end of 30 ticks."""
    context, session = line_context(), RosSession()
    shell = Shell(context, session, Clock(), {})
    ids = {tick: bytes([tick]) * 16 for tick in goals}

    def act(state):
        if state.tick in goals:
            session.call("send_goal", send_request(ids[state.tick], goals[state.tick]))
        if state.tick in then:
            session.call("cancel_goal", cancel_request(bytes(16)))
        return state.tick == 30

    shell.run("", act)
    calls = [session.call("get_result", result_request(each)) for each in ids.values()]
    shell._action.receive()
    shell._action.answer()
    return [(call.response.status, call.response.result.result, call.response.result.detail) for call in calls]


def test_a_client_of_ros_learns_what_became_of_its_goal():
    invalid = "goal invalid: goal:1:1: "
    achieved, refused = results_of({3: "(at home)", 8: "(at"})
    assert achieved == (GoalState.SUCCEEDED, "achieved", "")
    assert (refused[0], refused[1], refused[2][: len(invalid)]) == (GoalState.ABORTED, "refused", invalid)


def test_a_client_of_ros_cancels_its_goal_and_one_that_is_open_at_the_end_is_aborted():
    assert results_of({3: "(visited a)"}, then=[12]) == [(GoalState.CANCELED, "cancelled", "")]
    assert results_of({3: "(visited a)", 9: "(visited b)"}) == [
        (GoalState.ABORTED, "replaced", ""),
        (GoalState.ABORTED, "stopped", ""),
    ]


def test_a_goal_of_ros_that_waited_while_the_executive_stood_still_is_refused_and_a_later_one_counts():
    clock, session, waits = Clock(), RosSession(), []
    shell = Shell(line_context(), session, clock, {})

    def act(state):
        if state.tick in (10, 40):
            goal_id = bytes([state.tick]) * 16
            session.call("send_goal", send_request(goal_id, "(visited a)"))
            clock.ns += 12 * 10**9 * (state.tick == 10)
        if state.tick in (12, 42):
            waits.append(session.call("get_result", result_request(bytes([state.tick - 2]) * 16)))
        return state.tick == 50

    shell.run("", act)
    results = [(call.response.status, call.response.result.result) for call in waits]
    assert results == [(GoalState.ABORTED, "refused"), (GoalState.ABORTED, "stopped")]
    assert waits[0].response.result.detail.startswith("the executive stood still for 1")


def test_a_client_of_ros_cancels_while_another_client_sets_goals_all_the_time():
    class Flood(RosSession):
        def receive(self):
            return ServiceRequest("(visited b)", lambda *_: None)

    session, goal_id = Flood(), bytes(range(16))
    shell = Shell(line_context(), session, Clock(), {})
    calls = [session.call("send_goal", send_request(goal_id, "(visited a)"))]
    calls.append(session.call("cancel_goal", cancel_request(goal_id)))
    shell.run("", lambda state: state.tick == 9)
    assert all(call.responses for call in calls)


def test_a_goal_of_ros_without_conditions_drops_the_open_one_and_ends():
    dropped = (GoalState.ABORTED, "cancelled")
    assert results_of({3: "(visited a)", 9: "(and)"}) == [(*dropped, ""), (*dropped, "cancelled: (visited a)")]
    assert results_of({3: "(at home)", 9: "(and)"})[1] == (*dropped, "no goal is open")


class StoppedRouter(Goals):
    """A bus on which nothing arrives for a while from the eleventh tick on: its router was stopped."""

    def __init__(self, clock, requests, silent_s):
        super().__init__(clock, requests)
        self.since_ns = clock.ns + 10**9
        self.until_ns = self.since_ns + round(silent_s * 1e9)

    def drain(self, now_ns):
        return () if self.since_ns <= now_ns < self.until_ns else super().drain(now_ns)


def answer_behind_router(silent_s, delay_s, goal="(visited a)"):
    """The answer to a goal that comes `delay_s` after the end of a silence, and whether it counts."""
    clock = Clock()
    session = StoppedRouter(clock, {clock.ns + round((1.0 + silent_s + delay_s) * 1e9): goal}, silent_s)
    state = Shell(line_context(), session, clock, {}).run("", lambda state: bool(session.answers))
    return session.answers[0], state.task.goal


@pytest.mark.promise("P41")
@pytest.mark.parametrize("silent_s", [0.75, 0.9, 1.4])
@pytest.mark.parametrize("delay_s", [-0.05, 0.05, 0.8])
def test_a_goal_that_waited_in_a_stopped_router_is_refused(silent_s, delay_s):
    (accepted, text), goal = answer_behind_router(silent_s, delay_s)
    assert (accepted, goal) == (False, "")
    assert re.fullmatch(r"the bus was silent for [01]\.\d s; send the goal again if it holds", text)


@pytest.mark.parametrize(("silent_s", "delay_s"), [(0.4, 0.05), (0.9, 1.5), (60.0, 0.05), (60.0, -20.0)])
def test_a_goal_counts_after_a_short_silence_and_beside_a_robot_that_is_off(silent_s, delay_s):
    assert answer_behind_router(silent_s, delay_s) == ((True, "accepted"), "(visited a)")


def test_a_goal_before_the_first_message_of_a_robot_counts():
    clock = Clock()
    session = StoppedRouter(clock, {clock.ns + 9 * 10**8: "(visited a)"}, 0.0)
    session.since_ns, session.until_ns = 0, clock.ns + 10**10
    state = Shell(line_context(), session, clock, {}).run("", lambda state: bool(session.answers))
    assert (session.answers[0], state.task.goal) == ((True, "accepted"), "(visited a)")
