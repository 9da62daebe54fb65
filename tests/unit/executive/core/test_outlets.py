"""Several command outlets: an action commands those that it drives, the others rest, and all are published."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tailor.executive.core.command_guard import whole_command
from tailor.executive.core.state import initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.action import Control
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.domain import Axis
from tailor.executive.interfaces.outlet import Outlet, at_rest, messages_of
from tailor.executive.interfaces.reasons import Reason
from tailor.schemas.messages import JointCommand, VelocityCommand
from tests.support.toy_domain import SLIDE, LineDomain, inputs, line_context

BASE = (Axis("v", "m/s", -0.5, 0.5),)
HAND = (Axis("lift", "rad/s", -1.0, 1.0), Axis("grip", "m", 0.01, 0.08, kept=0.05))
MS = 1_000_000


class MobileHand(LineDomain):
    """The toy robot with a hand: slide drives the base alone."""

    axes = (*BASE, *HAND)
    actions = {"slide": replace(SLIDE, drives=("base",))}
    outlets = (
        Outlet("base", "cmd_vel", BASE, lambda command, stamp_ns: VelocityCommand(stamp_ns, command[0], 0.0)),
        Outlet("hand", "joint_cmd", HAND, lambda command, stamp_ns: JointCommand(stamp_ns, ("lift", "grip"), command)),
    )


DOMAIN = MobileHand()
SLIDING = DOMAIN.actions["slide"]
LAST = (0.3, 0.7, 0.02)


def test_what_an_action_does_not_drive_rests_and_a_gripper_keeps_its_width():
    assert whole_command(DOMAIN, SLIDING, (0.4,), LAST) == ((0.4, 0.0, 0.02), None)


def test_an_action_of_another_outlet_stops_the_base():
    gripping = replace(SLIDING, drives=("hand",))
    assert whole_command(DOMAIN, gripping, (0.5, 0.08), LAST) == ((0.0, 0.5, 0.08), None)


def test_limits_are_those_of_the_driven_axes():
    gripping = replace(SLIDING, drives=("hand",))
    assert whole_command(DOMAIN, gripping, (-9.0, 0.0), LAST) == ((0.0, -1.0, 0.01), None)


@pytest.mark.parametrize("bad", [(float("nan"),), (), (0.1, 0.1, 0.1)])
def test_a_rejected_command_brings_all_axes_to_rest(bad):
    command, cause = whole_command(DOMAIN, SLIDING, bad, LAST)
    assert command == (0.0, 0.0, 0.02)
    assert cause is not None
    assert cause.reason is Reason.COMMAND_INVALID


def test_an_action_that_names_no_outlet_drives_all():
    assert whole_command(DOMAIN, SLIDE, LAST, (0.0, 0.0, 0.05)) == (LAST, None)


def test_rest_before_the_first_command_is_the_declared_set_point():
    assert at_rest(DOMAIN.axes) == (0.0, 0.0, 0.05)
    assert at_rest(DOMAIN.axes, LAST) == (0.0, 0.0, 0.02)


def test_each_outlet_has_a_message_of_its_own():
    assert messages_of(DOMAIN, LAST, 7) == (
        ("cmd_vel", VelocityCommand(7, 0.3, 0.0)),
        ("joint_cmd", JointCommand(7, ("lift", "grip"), (0.7, 0.02))),
    )


def run(ticks: int, controller=None):
    """Commands of each tick, by topic."""
    domain = MobileHand()
    if controller is not None:
        domain.actions = {"slide": replace(SLIDING, controller=controller)}
    context = replace(line_context(Settings()), domain=domain)
    state, x, published = initial_state(context), 0.0, []
    for tick in range(1, ticks + 1):
        goal = context.problem.goal_text if tick == 1 else ""
        state, outputs = step(context, state, tick * 100 * MS, inputs(tick * 100 * MS, x, goal), CheckBudget(2000))
        published.append({o.topic: o.message for o in outputs if o.topic in ("cmd_vel", "joint_cmd")})
        x += 0.1 * state.command[0]
    return published


def test_all_outlets_are_published_in_each_tick_of_a_run():
    published = [tick for tick in run(20) if tick]
    assert all(set(tick) == {"cmd_vel", "joint_cmd"} for tick in published)
    assert max(tick["cmd_vel"].v for tick in published) > 0.1
    assert {tick["joint_cmd"].velocities for tick in published} == {(0.0, 0.05)}


def test_the_width_that_an_action_chose_is_kept_when_it_fails():
    def grip_then_fail(state, now_ns, belief, arguments):
        count = (state or 0) + 1
        return Control(count, (0.2, 0.0, 0.03), "failed" if count > 3 else "running", "slipped")

    domain = MobileHand()
    domain.actions = {"slide": replace(SLIDING, drives=(), controller=grip_then_fail)}
    context = replace(line_context(Settings()), domain=domain)
    state = initial_state(context)
    for tick in range(1, 12):
        goal = context.problem.goal_text if tick == 1 else ""
        state, _ = step(context, state, tick * 100 * MS, inputs(tick * 100 * MS, 0.0, goal), CheckBudget(2000))
    assert state.fault is not None
    assert state.command == (0.0, 0.0, 0.03)
