"""A plan whose instantiation is refused is not executed: others are tried, and the task fails if there are none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tailor.executive import domains
from tailor.executive.composition import ExecutiveConfig, build_context
from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.domain import Conflict
from tailor.executive.interfaces.reasons import Reason
from tailor.executive.replay import replay
from tailor.schemas.messages import ActionFinished, PlanReport
from tailor.simnodes.world import World
from tailor.tools.lockstep.action_run import new_body
from tailor.tools.lockstep.run import SENDER, run_lockstep
from tests.replay.test_replay_core import FickleBudget
from tests.support.toy_domain import line_context
from tests.unit.executive.deliberation.test_external_planner import WITH_PLANNER, Run, answer_of, plainly
from tests.unit.executive.deliberation.test_improvement import PLACES, PROBLEM, drive, messages_of, steps

EITHER = "(or (visited a) (visited b) (visited c))"


def refusing(nowhere, settings=None, places=PLACES, problem=PROBLEM):
    """The line with three places, of which some are nowhere from a belief's shift on."""
    context = line_context(settings, places, problem)
    domain = context.domain
    value = domain.value

    def refused(query):
        if ("at", query.label) not in query.holds and query.belief.shift >= nowhere.get(query.label, 9.0):
            raise Conflict(f"{query.label} is nowhere")
        return value(query)

    domain.value = refused
    return context


def first_place():
    """Where the planner's first plan leads."""
    _, published, _ = drive(refusing({}), 999, goal=EITHER)
    return driven(published)[0]


def driven(published):
    return [action[2] for action in steps(messages_of(published, PlanReport)[0][1])]


@pytest.mark.parametrize("costs", ["steps", "models"])
def test_the_next_plan_is_executed(costs):
    first = first_place()
    states, published, _ = drive(refusing({first: 0.0}, Settings(plan_costs=costs)), 999, goal=EITHER)
    assert states[-1].task.result == "achieved"
    assert len(driven(published)) == 1
    assert driven(published) != [first]


def test_a_plan_with_one_more_step_is_tried_as_well():
    states, published, _ = drive(refusing({"a": 0.0}), 999, goal="(or (visited a) (and (visited b) (visited c)))")
    assert states[-1].task.result == "achieved"
    assert sorted(driven(published)) == ["b", "c"]


def test_without_another_plan_the_task_fails_for_the_reason_of_the_first():
    nowhere = dict.fromkeys("abc", 0.0)
    states, published, _ = drive(refusing(nowhere), 999, goal=EITHER)
    assert states[-1].task.result_cause.reason is Reason.NOT_INSTANTIABLE
    assert states[-1].task.result_cause.detail.endswith(f"{first_place()} is nowhere")
    assert not messages_of(published, ActionFinished)


def test_the_choice_is_the_same_however_the_work_is_divided_and_is_replayed_bit_for_bit():
    first = first_place()
    expected = driven(drive(refusing({first: 0.0}), 999, goal=EITHER)[1])
    rng = np.random.default_rng(3)
    _, published, ticks = drive(refusing({first: 0.0}), 999, 150, lambda: FickleBudget(rng), EITHER)
    assert driven(published) == expected
    assert list(replay(refusing({first: 0.0}), ticks)) == published


def test_the_rest_of_a_plan_that_is_refused_gives_way_to_another_plan():
    goal = "(and (visited a) (or (visited b) (visited c)))"
    last = driven(drive(refusing({}), 999, goal=goal)[1])[1]
    states, published, _ = drive(refusing({last: 0.01}), 4, goal=goal)
    assert driven(published) == ["a", last]
    assert states[-1].task.result == "achieved"
    reports = [report for _, report in messages_of(published, PlanReport)]
    assert [report.way for report in reports[:2]] == ["searched", "searched"]
    assert steps(reports[1])[0][2] not in ("a", last)


def test_a_shortcut_that_is_refused_leaves_the_rest_of_the_plan():
    more = {**PLACES, "d": {"x": 1.2}}, PROBLEM.replace("b c)", "b c d)").replace("(place c)", "(place c) (place d)")
    goal = "(and (visited a) (or (visited c) (and (visited b) (visited d))))"
    states, published, _ = drive(refusing({"c": 0.0}, None, *more), 999, goal=goal)
    assert driven(published) == ["a", "b", "d"]
    assert [report.way for _, report in messages_of(published, PlanReport)] == ["searched", *["suffix"] * 3]
    assert states[-1].task.result == "achieved"


def test_an_external_planner_whose_plan_is_refused_has_failed():
    (report, *_) = externally({}).messages(PlanReport)
    (place,) = [action[2] for action in steps(report[1])]
    run = externally({place: 0.0})
    reports = [report for _, report in run.messages(PlanReport)]
    assert [(report.status, report.way) for report in reports[:2]] == [("failed", "external"), ("solved", "searched")]
    assert reports[0].reason == Reason.NOT_INSTANTIABLE
    assert reports[0].detail == f"slide home {place}: {place} is nowhere"
    assert run.state.task.result == "achieved"


def externally(nowhere):
    context = refusing(nowhere, WITH_PLANNER)
    return Run(lambda request: answer_of(request, plainly), context=context).go(goals=((1, EITHER),))


def test_the_kitchen_reaches_out_where_there_is_a_spot():
    context = build_context(ExecutiveConfig("kitchen", "one-cup", Settings(seed=5)), SENDER)
    _, start = domains.seeded_scenario("kitchen", "one-cup", 5)
    context = replace(context, problem=context.problem.with_goal("(arm-out)"))
    run = run_lockstep(context, World(new_body(context.domain), start, 5), limit_s=60)
    assert run.achieved
    assert [finished.action for finished in run.finished] == ["goToPose", "reach"]
