"""The live shell around a core whose robot's code raises in the midst of a run."""

import dataclasses

import pytest

from tailor.executive.shell import Shell
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import TickReport, VelocityCommand
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

    def __init__(self):
        self.published, self._tick = [], 0

    def inbox(self, topics, robot):
        return self

    def drain(self, now_ns):
        self._tick += 1
        return odometry(now_ns, 0.0, self._tick), driver(now_ns)

    def service_server(self, key):
        return self

    def poll(self):
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
