"""Axes that keep their set-point: what people move by hand while the driver obeys nobody stays there when it obeys."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tailor.executive.core.state import Inputs, initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.outlet import staying
from tests.support.toy_domain import driver, line_context, odometry
from tests.unit.executive.core.test_outlets import LAST, MobileHand

MS = 1_000_000
TICK = 100 * MS
ARMED_AT, DISARMED_AT, ARMED_AGAIN_AT = 3, 10, 16


class FeelingHand(MobileHand):
    """It feels how wide its gripper is: the y of odometry."""

    def kept(self, belief):
        return (9.0, 9.0, belief.shift)


DOMAIN = FeelingHand()


def width_at(n):
    """People open the gripper before anybody has armed the robot, and again while it is disarmed."""
    return 0.06 if n < DISARMED_AT + 2 else 0.07


def published(mode_at, silent=(), domain=DOMAIN, ticks=24):
    """Width that is commanded in each tick in which anything is, with odometry but in the `silent` ticks."""
    context = replace(line_context(Settings()), domain=domain)
    state, sent = initial_state(context), {}
    for n in range(1, ticks):
        now_ns = n * TICK
        percepts = () if n in silent else (odometry(now_ns, 0.0, n, width_at(n)),)
        goal = "(visited b)" if n == 1 else ""
        given = Inputs((*percepts, driver(now_ns, mode_at(n))), goal)
        state, outputs = step(context, state, now_ns, given, CheckBudget(50))
        for output in outputs:
            if output.topic == "joint_cmd":
                sent[n] = output.message.velocities[1]
    return sent


@pytest.mark.parametrize("halted", ["disarmed", "stopped", "estopped"])
def test_arming_moves_no_gripper_that_people_have_moved(halted):
    sent = published(lambda n: "armed" if ARMED_AT <= n < DISARMED_AT or n >= ARMED_AGAIN_AT else halted)
    assert sent == {
        **dict.fromkeys(range(ARMED_AT, DISARMED_AT), 0.06),
        **dict.fromkeys(range(ARMED_AGAIN_AT, 24), 0.07),
    }


def test_a_width_from_before_its_sensor_fell_silent_is_kept():
    sent = published(lambda n: "armed" if n >= ARMED_AGAIN_AT else "disarmed", silent=range(DISARMED_AT, 24))
    assert set(sent.values()) == {0.06}


def test_before_its_sensor_publishes_the_declared_set_point_counts():
    sent = published(lambda n: "armed" if n >= ARMED_AT else "disarmed", silent=range(24))
    assert set(sent.values()) == {0.05}


def test_while_the_driver_obeys_the_set_point_stays_whatever_is_measured():
    sent = published(lambda n: "armed" if n >= ARMED_AT else "disarmed")
    assert set(sent.values()) == {0.06}


def test_a_domain_that_does_not_feel_its_gripper_keeps_the_last_set_point():
    sent = published(lambda n: "armed" if n >= ARMED_AT else "disarmed", domain=MobileHand())
    assert set(sent.values()) == {0.05}


@pytest.mark.parametrize(
    ("felt", "expected"), [(0.03, 0.03), (0.0801, 0.08), (0.0, 0.01), (float("nan"), 0.02), (float("inf"), 0.02)]
)
def test_a_width_beyond_the_limits_becomes_the_limit_and_one_that_is_none_changes_nothing(felt, expected):
    belief = replace(DOMAIN.initial_belief(), shift=felt)
    assert staying(DOMAIN, belief, LAST) == (0.0, 0.0, expected)
