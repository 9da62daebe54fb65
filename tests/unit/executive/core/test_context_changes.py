"""A run among objects: their rows are published with the decision, and one in the way starts a new deliberation."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from tailor.executive.core import adoption
from tailor.executive.core.course import HALT_NS
from tailor.executive.core.state import initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.action_context import ActionContext, ContextColumn
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.schemas import codec
from tailor.schemas.messages import (
    ActionFinished,
    ActionObjects,
    Contexts,
    Odometry,
    RefinementReport,
    Subgoals,
    VelocityCommand,
)
from tests.support.toy_domain import SLIDE, LineBelief, LineDomain, LineModel, inputs, line_context

MS = 1_000_000
WALL = ActionContext(
    (ContextColumn("wall_x", "m", -10.0, 100.0, tolerance=0.2),),
    lambda belief: np.array([[wall] for wall in belief.walls]).reshape(-1, 1),
    "slide/clearance",
    "wall",
)


@dataclass(frozen=True, slots=True)
class WalledBelief(LineBelief):
    walls: tuple[float, ...] = ()


class BesideWall:
    """Success near one: 0.99, unless the wall stands in the way, which is 30 m long."""

    card = {"sha256": "toy"}

    def probability(self, arguments):
        assert arguments.shape[1] == 4
        return np.where(arguments[:, 3] < 30.0, 0.5, 0.99)


class RunUp:
    """Success ahead, beyond a wall: sure from a metre behind home, where the robot takes a run-up, and nowhere else."""

    card = {"sha256": "toy"}

    def probability(self, arguments):
        return np.where((arguments[:, 1] > 0.0) & (arguments[:, 0] > -1.0), 0.02, 0.999)


class ShortRunUp:
    """Success ahead, beyond a wall: sure from just behind home, else probable."""

    card = {"sha256": "toy"}

    def probability(self, arguments):
        return np.where((arguments[:, 1] > 0.0) & (arguments[:, 0] > -0.05), 0.8, 0.999)


class RiskyAhead:
    """Success near one, unless a wall stands in the way: then probable wherever the robot starts."""

    card = {"sha256": "toy"}

    def probability(self, arguments):
        return np.where(arguments[:, 3] < 30.0, 0.8, 0.999)


class WalledLine(LineDomain):
    """The toy robot that believes walls: as many as odometry has radians, at odometry's y."""

    actions = {"slide": replace(SLIDE, context=WALL)}

    def initial_belief(self):
        return WalledBelief()

    def update(self, belief, now_ns, samples, command):
        for sample in samples:
            if isinstance(sample.message, Odometry):
                moved = sample.message
                belief = replace(belief, x=moved.x, seen=True, walls=(moved.y,) * round(moved.phi))
        return belief


class RetreatingLine(WalledLine):
    """The same robot, which may drive elsewhere first."""

    actions = {"slide": replace(SLIDE, context=replace(WALL, failure_cost_s=60.0), subgoal_action="slide")}


class WaryLine(RetreatingLine):
    """The same robot, for which the wall costs less: it does not brake for the risk alone."""

    actions = {"slide": replace(SLIDE, context=replace(WALL, failure_cost_s=14.0), subgoal_action="slide")}


def run(walls, domain=None, success=None, checks=2000):
    """Outputs of one tick for each (number of walls, their place); `checks` are those of all ticks but the first."""
    models = Models({"slide/duration": LineModel()}, {"slide/clearance": success or BesideWall()})
    context = replace(line_context(Settings()), domain=domain or WalledLine(), models=models)
    state, x, ticks = initial_state(context), 0.0, []
    for tick, (count, place) in enumerate(walls, 1):
        received = inputs(tick * 100 * MS, x, context.problem.goal_text if tick == 1 else "")
        odom = replace(received.samples[0].message, y=place, phi=float(count))
        samples = (replace(received.samples[0], message=odom), *received.samples[1:])
        budget = CheckBudget(checks if tick > 1 else 15 * checks)
        state, outputs = step(context, state, tick * 100 * MS, replace(received, samples=samples), budget)
        ticks.append((state.deliberations, [output.message for output in outputs]))
        x += 0.1 * state.command[0]
    return ticks


def published(ticks, kind):
    return [
        (tick, message) for tick, (_, messages) in enumerate(ticks, 1) for message in messages if type(message) is kind
    ]


def test_rows_are_published_in_the_tick_of_the_decision():
    ticks = run([(1, 40.0)] * 8)
    (at, contexts), (decided, _) = published(ticks, Contexts)[0], published(ticks, Subgoals)[0]
    assert at == decided == contexts.tick
    assert contexts.contexts == (ActionObjects("slide", ("wall_x",), (40.0,)),)
    assert codec.decode(Contexts, codec.encode(contexts)) == contexts


def test_nothing_is_published_without_objects():
    ticks = run([(0, 0.0)] * 8)
    assert published(ticks, Subgoals)
    assert not published(ticks, Contexts)


@pytest.mark.parametrize(
    ("later", "new"),
    [
        ((1, 40.1), False),
        ((1, 45.0), False),
        ((2, 40.0), False),
        ((0, 40.0), False),
        ((1, 9.0), True),
        ((2, 9.0), True),
    ],
)
def test_only_an_object_that_puts_the_course_at_risk_starts_a_new_deliberation(later, new):
    ticks = run([(1, 40.0)] * 6 + [later] * (10 if new else 4))  # it may brake first
    assert ticks[5][0] == 1
    assert (ticks[-1][0] > 1) is new


def test_robot_brakes_before_it_decides_anew_where_the_course_will_probably_fail():
    ticks = run([(1, 40.0)] * 6 + [(2, 9.0)] * 12)
    (at, ended), *_ = published(ticks, ActionFinished)
    assert (at, ended.outcome, ended.reason) == (7, "aborted", "course at risk")
    commands = dict(published(ticks, VelocityCommand))
    assert commands[7].v > 0
    braking = HALT_NS // (100 * MS)
    assert [commands[tick].v for tick in range(8, 8 + braking)] == [0.0] * braking
    assert [deliberations for deliberations, _ in ticks[6 : 7 + braking]] == [1] * braking + [2]


def test_it_brakes_also_while_the_search_for_its_first_choice_goes_on():
    ticks = run([(1, 40.0)] * 6 + [(2, 9.0)] * 12, checks=1)
    commands = dict(published(ticks, VelocityCommand))
    assert commands[7].v > 0
    assert [message.finished for _, message in published(ticks, RefinementReport)[:5]] == [False] * 5
    (at, ended), *_ = published(ticks, ActionFinished)
    assert (at, ended.outcome, ended.reason) == (7, "aborted", "course at risk")
    assert commands[8].v == 0


def test_robot_drives_on_without_its_subgoal_once_the_object_is_gone():
    ticks = run([(1, 40.0)] * 10 + [(0, 40.0)] * 3, RetreatingLine(), RunUp())
    commands = dict(published(ticks, VelocityCommand))
    assert commands[10].v < 0
    assert [action.asserted for action in published(ticks, Subgoals)[0][1].actions][:2] == [True, False]
    (at, ended), *_ = published(ticks, ActionFinished)
    assert (at, ended.outcome, ended.reason) == (11, "aborted", "superseded")
    changed, subgoals = published(ticks, Subgoals)[-1]
    assert changed == 11
    assert not subgoals.actions[0].asserted
    assert commands[12].v > 0
    assert ticks[-1][0] == 1  # without a new deliberation


@pytest.mark.parametrize("too_fast", [False, True])
def test_robot_that_is_too_fast_for_its_models_brakes_before_it_drives_around_an_object(monkeypatch, too_fast):
    monkeypatch.setattr(adoption, "begins_too_fast", lambda sequence: too_fast)
    ticks = run([(0, 0.0)] * 5 + [(1, 40.0)] * 3, WaryLine(), ShortRunUp())
    (at, ended), *_ = published(ticks, ActionFinished)
    commands = dict(published(ticks, VelocityCommand))
    assert commands[5].v > 0
    assert (ended.outcome, ended.reason) == ("aborted", "course at risk" if too_fast else "superseded")
    last = published(ticks, Subgoals)[-1]
    assert last[1].actions[0].asserted is not too_fast
    assert commands[at + 1].v == 0 if too_fast else commands[at + 1].v < 0


def test_robot_that_is_too_fast_does_not_brake_for_a_decision_without_a_subgoal(monkeypatch):
    monkeypatch.setattr(adoption, "begins_too_fast", lambda sequence: True)
    ticks = run([(1, 40.0)] * 6 + [(1, 9.0)] * 3, WaryLine(), RiskyAhead())
    assert ticks[-1][0] > 1
    assert not published(ticks, ActionFinished)
    assert all(message.v > 0 for tick, message in published(ticks, VelocityCommand) if tick > 5)


def test_the_same_inputs_give_the_same_messages():
    walls = [(1, 40.0)] * 5 + [(2, 41.0)] * 10
    first, second = run(walls), run(walls)
    assert [m for _, messages in first for m in messages] == [m for _, messages in second for m in messages]
