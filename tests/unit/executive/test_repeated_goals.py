"""Goals that are sent again, e.g. by a ROS node in a loop: the open one goes on, one that has ended begins anew."""

import pytest

from tailor.executive.core.modes import Mode
from tailor.executive.deliberation.context import PERIOD_NS
from tailor.executive.shell import Shell
from tailor.runtime.bus.service import ACCEPTED
from tailor.schemas.messages import ActionFinished, TickReport, VelocityCommand
from tailor.schemas.ros2.action_messages import GoalState
from tests.support.ros2.action_client import ClientSession, result_request, send_request
from tests.support.toy_domain import driver, line_context, odometry
from tests.unit.executive.test_shell import Clock, Goals

GOAL = "(and (visited a) (visited b))"
END = 40  # ticks; the goal takes fewer
TOO_FAR = {"home": {"x": 0.0}, "a": {"x": 95.0}, "b": {"x": 1.0}}  # for the controller, which gives up


class MovingGoals(Goals):
    """A bus with requests for goals, and a robot that moves as it is commanded."""

    x = 0.0

    def drain(self, now_ns):
        self._tick += 1
        commands = [each.v for each in self.published if isinstance(each, VelocityCommand)]
        self.x += 0.1 * commands[-1] if commands else 0.0
        return odometry(now_ns, self.x, self._tick), driver(now_ns)


class ActionClient(ClientSession, MovingGoals):
    """The same bus with a client of ROS 2's action."""

    def __init__(self, clock):
        ClientSession.__init__(self)
        MovingGoals.__init__(self, clock, {})


def run(goals, context=None):
    """The bus and the last state, where goals are requested by tick."""
    clock = Clock()
    session = MovingGoals(clock, {clock.ns + tick * PERIOD_NS: goal for tick, goal in goals.items()})
    return session, Shell(context or line_context(), session, clock, {}).run("", lambda state: state.tick == END)


def driven(goals, context=None):
    """Actions that ended, goals that were begun, and the last state, where all goals are accepted."""
    session, state = run(goals, context)
    assert session.answers == [(True, ACCEPTED)] * len(goals)
    ends = [each.outcome for each in session.published if isinstance(each, ActionFinished)]
    return ends, [each.goal for each in session.published if isinstance(each, TickReport) and each.goal], state


@pytest.mark.parametrize("sent", [GOAL, f" {GOAL}\n"])
def test_the_open_goal_that_is_sent_again_in_every_tick_goes_on(sent):
    once, again = driven({3: GOAL}), driven({3: GOAL} | dict.fromkeys(range(4, 25), sent))
    assert again[:2] == once[:2] == (["done", "done"], [GOAL])
    assert again[2].task.result == "achieved"


def test_a_goal_that_has_ended_begins_anew():
    _, begun, state = driven({3: "(visited a)", 30: "(visited a)"})
    assert (begun, state.task.result) == (["(visited a)"] * 2, "achieved")


def test_a_goal_that_has_ended_in_a_fault_begins_anew():
    once, again = (driven(goals, line_context(places=TOO_FAR)) for goals in ({3: GOAL}, {3: GOAL, 30: GOAL}))
    assert once[2].mode is Mode.FAULT
    assert (len(again[0]), again[1]) == (2 * len(once[0]), [GOAL] * 2)


@pytest.mark.promise("P30")
def test_a_goal_that_is_sent_all_the_time_ends_no_fault():
    """A fault, which waits for people, was over in the next tick, and so for ever."""
    session, state = run(dict.fromkeys(range(3, END), GOAL), line_context(places=TOO_FAR))
    assert state.mode is Mode.FAULT
    assert [each.outcome for each in session.published if isinstance(each, ActionFinished)] == ["failed"] * 2
    fault = "repeated failure: slide: controller failed: too far"
    assert session.answers[-1] == (
        False,
        f"this goal ended in a fault ({fault}), and is sent all the time: end its sender, or send it again after 1 s",
    )


@pytest.mark.promise("P41")
@pytest.mark.parametrize(("pause", "moves"), [(0, False), (8, False), (11, True)])
def test_a_goal_that_is_sent_all_the_time_is_not_pursued_after_people_dropped_it(pause, moves):
    goals = dict.fromkeys(range(3, 8), GOAL) | {8: "(and)"} | dict.fromkeys(range(8 + max(1, pause), END), GOAL)
    session, state = run(goals)
    ends = [each.outcome for each in session.published if isinstance(each, ActionFinished)]
    assert ends == (["aborted", "done", "done"] if moves else ["aborted"])
    if not moves:
        assert (state.task.result, state.command) == ("cancelled", (0.0,))
        assert session.answers[-1][1].startswith("this goal was cancelled, and is sent all the time: end its sender")


def test_another_goal_replaces_the_open_one():
    ends, begun, _ = driven({3: GOAL, 6: "(visited b)"})
    assert (ends, begun) == (["aborted", "done"], [GOAL, "(visited b)"])


def test_a_client_of_ros_that_sends_the_open_goal_under_new_ids_lets_the_robot_drive_on():
    session = ActionClient(Clock())
    shell, ids = Shell(line_context(), session, session.clock, {}), [bytes([n]) * 16 for n in range(1, 6)]

    def act(state):
        if 1 <= state.tick <= len(ids):
            session.call("send_goal", send_request(ids[state.tick - 1], GOAL))
        return state.tick == END

    shell.run("", act)
    calls = [session.call("get_result", result_request(each)) for each in ids]
    shell._action.answer()
    states = [(call.response.status, call.response.result.result) for call in calls]
    assert states == [(GoalState.ABORTED, "replaced")] * 4 + [(GoalState.SUCCEEDED, "achieved")]
    assert [each.outcome for each in session.published if isinstance(each, ActionFinished)] == ["done", "done"]
