"""A run among objects: their rows are published with the decision, and one in the way starts a new deliberation."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from tailor.executive.core.state import initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.action_context import ActionContext, ContextColumn
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.schemas import codec
from tailor.schemas.messages import ActionFinished, ActionObjects, Contexts, Odometry, Subgoals, VelocityCommand
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


def run(walls):
    """Outputs of one tick for each (number of walls, their place)."""
    models = Models({"slide/duration": LineModel()}, {"slide/clearance": BesideWall()})
    context = replace(line_context(Settings()), domain=WalledLine(), models=models)
    state, x, ticks = initial_state(context), 0.0, []
    for tick, (count, place) in enumerate(walls, 1):
        received = inputs(tick * 100 * MS, x, context.problem.goal_text if tick == 1 else "")
        odom = replace(received.samples[0].message, y=place, phi=float(count))
        samples = (replace(received.samples[0], message=odom), *received.samples[1:])
        state, outputs = step(context, state, tick * 100 * MS, replace(received, samples=samples), CheckBudget(2000))
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
    ticks = run([(1, 40.0)] * 6 + [(2, 9.0)] * 10)
    (at, ended), *_ = published(ticks, ActionFinished)
    assert (at, ended.outcome, ended.reason) == (7, "aborted", "course at risk")
    commands = dict(published(ticks, VelocityCommand))
    assert commands[7].v > 0
    assert [commands[tick].v for tick in range(8, 14)] == [0.0] * 6
    assert [deliberations for deliberations, _ in ticks[6:13]] == [1] * 6 + [2]


def test_the_same_inputs_give_the_same_messages():
    walls = [(1, 40.0)] * 5 + [(2, 41.0)] * 10
    first, second = run(walls), run(walls)
    assert [m for _, messages in first for m in messages] == [m for _, messages in second for m in messages]
