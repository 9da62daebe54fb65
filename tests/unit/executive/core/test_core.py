"""The core, tick by tick, with a robot on a line."""

from __future__ import annotations

import dataclasses
import itertools
from itertools import pairwise

import numpy as np
import pytest

from tailor.executive import planning
from tailor.executive.core.command_guard import checked
from tailor.executive.core.execution import Running
from tailor.executive.core.modes import Conditions, Mode, next_mode
from tailor.executive.core.state import Inputs, initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import MAX_GOAL_BYTES, Settings, check_goal
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.domain import Axis
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.reasons import Cause, Reason, Result
from tailor.schemas import codec
from tailor.schemas.messages import (
    ActionFinished,
    ArmRequest,
    ExecStatus,
    PlanReport,
    RefinementReport,
    Subgoals,
    VelocityCommand,
)
from tailor.schemas.topics import TOPICS
from tests.support.toy_domain import CLOSED, CREEP_MPS, SENDER, SLIDE, driver, inputs, line_context, odometry

TICK = 100_000_000
GOAL = "(and (visited a) (visited b) (at b))"
HOLD, DISARMED = Cause(Reason.INPUT_STALE, "odom"), Cause(Reason.DRIVER_NOT_ARMED, "stopped")
FAULT = Cause(Reason.REPEATED_FAILURE, "slide")


def drive(context, goal=GOAL, ticks=100, checks=200, world=None):
    """Run the core against a point on a line that executes each command; yields (state, outputs, x) each tick."""
    state, x = initial_state(context), 0.0
    for n in range(1, ticks + 1):
        given = inputs(n * TICK, x, goal if n == 1 else "")
        if world is not None:
            given = world(n, given, x)
        state, outputs = step(context, state, n * TICK, given, CheckBudget(checks(n) if callable(checks) else checks))
        x += 0.1 * state.command[0]
        yield state, outputs, x


def messages(run, kind):
    return [output.message for _, outputs, _ in run for output in outputs if isinstance(output.message, kind)]


def test_goal_is_planned_refined_and_reached_in_order():
    run = list(drive(line_context()))
    state = run[-1][0]
    finished = messages(run, ActionFinished)
    assert state.task.result == "achieved"
    assert [(f.action, f.outcome, f.action_index) for f in finished] == [("slide", "done", 0), ("slide", "done", 1)]
    assert run[-1][2] == pytest.approx(1.0, abs=0.06)
    assert state.mode is Mode.READY
    assert state.command == (0.0,)


def test_refinement_chooses_the_fast_speed_that_greedy_leaves_at_the_next_place():
    subgoals = messages(list(drive(line_context())), Subgoals)
    speeds = [p.value for a in subgoals[0].actions for p in a.parameters if p.name == "v"]
    assert speeds[0] == pytest.approx(0.5, abs=0.01)


def test_plan_is_reused_as_suffix_after_each_action():
    ways = [(plan.status, plan.way) for plan in messages(list(drive(line_context())), PlanReport)]
    assert ways[0] == ("solved", "searched")
    assert ways[1] == ("solved", "suffix")


def test_same_inputs_and_checks_give_the_same_outputs():
    first = [outputs for _, outputs, _ in drive(line_context(), checks=7)]
    assert first == [outputs for _, outputs, _ in drive(line_context(), checks=7)]


def test_a_step_consumes_its_state_for_the_deliberation_is_resumed_in_place():
    context = line_context()
    before, _ = step(context, initial_state(context), TICK, inputs(TICK, 0.0, GOAL), CheckBudget(0))
    stage = before.deliberation.stage
    after, _ = step(context, before, 2 * TICK, inputs(2 * TICK, 0.0), CheckBudget(200))
    assert after.deliberation is before.deliberation
    assert before.deliberation.stage != stage


def test_starved_budget_only_delays_and_never_moves_without_a_decision():
    run = list(drive(line_context(), checks=1, ticks=300))
    assert run[0][0].command == (0.0,)
    assert run[-1][0].task.result == "achieved"


@pytest.mark.promise("P6")
@pytest.mark.parametrize("silent", ["odom", "driver"])
def test_stale_input_stops_the_robot_within_its_limit_and_motion_resumes_with_it(silent):
    def world(n, given, x):
        if 8 <= n < 18:
            return Inputs(tuple(s for s in given.samples if not s.key.endswith(silent)))
        return given

    run = list(drive(line_context(), world=world, ticks=120))
    moving = [abs(state.command[0]) > 0 for state, _, _ in run]
    assert moving[5]
    assert not any(moving[13:17])  # the last sample came in tick 7: stale after 0.5 s
    assert run[14][0].mode is (Mode.HOLDING if silent == "odom" else Mode.DISARMED)
    assert run[-1][0].task.result == "achieved"


def test_commands_go_out_only_while_the_driver_obeys_this_executive():
    def other(n, given, x):
        return Inputs((odometry(n * TICK, x, n), driver(n * TICK, sender="ff" * 16)), given.goal)

    run = list(drive(line_context(), world=other, ticks=10))
    assert messages(run, VelocityCommand) == []
    assert run[-1][0].cause == Cause(Reason.DRIVER_OBEYS_ANOTHER, "ff" * 4)


def test_driver_is_requested_to_arm_once_and_never_again_after_it_stopped_or_restarted():
    def world(n, given, x):
        mode = "disarmed" if n <= 3 else "armed" if n < 10 else "stopped" if n < 20 else "disarmed"
        epoch = 7 if n < 20 else 8
        return Inputs((odometry(n * TICK, x, n), driver(n * TICK, mode, epoch)), given.goal)

    run = list(drive(line_context(), world=world, ticks=40))
    requests = messages(run, ArmRequest)
    assert requests == [ArmRequest(arm=True, reset=False, sender=SENDER, epoch=7)]
    assert run[-1][0].mode is Mode.DISARMED
    assert all(state.command == (0.0,) for state, _, _ in run[9:])


@pytest.mark.promise("P30")
def test_failing_action_is_replanned_once_and_then_a_fault():
    context = line_context(places={"home": {"x": 0.0}, "a": {"x": 95.0}, "b": {"x": 1.0}})
    run = list(drive(context, goal="(visited a)", ticks=20))
    finished = messages(run, ActionFinished)
    assert [(f.outcome, f.reason, f.detail) for f in finished] == [("failed", Reason.CONTROLLER_FAILED, "too far")] * 2
    assert run[-1][0].mode is Mode.FAULT
    assert run[-1][0].cause == Cause(Reason.REPEATED_FAILURE, "slide: controller failed: too far")
    assert run[-1][0].command == (0.0,)


@pytest.mark.promise("P30")
def test_action_that_never_ends_fails_at_its_time_limit():
    def stuck(n, given, x):
        return inputs(n * TICK, 0.0, given.goal)

    run = list(drive(line_context(), world=stuck, ticks=130))
    finished = messages(run, ActionFinished)
    assert finished[0].outcome == "failed"
    failed = next(n for n, (state, _, _) in enumerate(run) if state.task.finished == 1)
    assert [run[n][0].command[0] for n in (failed - 1, failed)] == [0.5, 0.0]
    assert (finished[0].reason, finished[0].detail) == (Reason.ACTION_TIMEOUT, "10.0 s")


@pytest.mark.promise("P30")
@pytest.mark.parametrize("every", [10, 50, 90])
def test_a_robot_that_is_stuck_fails_as_well_if_the_place_that_it_drives_to_moves_again_and_again(every):
    """Each time it was given three times as long as until then: it pushed on for ever."""

    def stuck(n, given, x):
        return Inputs((odometry(n * TICK, 0.0, n, 0.3 * (n // every % 2)), driver(n * TICK)), given.goal)

    run = list(drive(line_context(), goal="(visited a)", world=stuck, ticks=400))
    finished = messages(run, ActionFinished)
    assert [(f.outcome, f.reason) for f in finished] == [("failed", Reason.ACTION_TIMEOUT)] * 2
    assert max(f.actual_s for f in finished) <= 10.1
    assert run[-1][0].mode is Mode.FAULT


def test_a_redirected_action_has_the_time_of_the_longest_way_that_was_left():
    running = Running(SLIDE, 1, False, (), 6.0, 0)
    assert running.time_limit_s() == 18.0
    at_s = [(2, 5.0), (10, 9.0), (30, 8.0), (50, float("inf")), (60, 1.0)]
    limits = []
    for now_s, left_s in at_s:
        running = running.redirected(dataclasses.replace(running, predicted_s=left_s), round(now_s * 1e9))
        limits.append(running.time_limit_s())
    assert limits == [3 * (2 + 5), 3 * (6 + 9), 3 * (6 + 9), 10.0, 3 * (6 + 9)]


@pytest.mark.promise("P28")
def test_unsolvable_goal_is_reported_once_and_nothing_moves():
    run = list(drive(line_context(), goal="(visited home)", ticks=10))
    assert run[-1][0].task.result is Result.FAILED
    assert run[-1][0].task.result_cause.reason is Reason.UNSOLVABLE
    assert all(state.command == (0.0,) for state, _, _ in run)
    assert len(messages(run, PlanReport)) == 1


def test_a_goal_too_long_for_a_status_is_refused_and_the_longest_one_is_published():
    context = line_context()
    longest = GOAL + " " * (MAX_GOAL_BYTES - len(GOAL))
    assert check_goal(context, longest) is None
    assert check_goal(context, longest + " ") == Cause(Reason.GOAL_TOO_LONG, "8001 bytes, expected at most 8000")
    run = drive(context, goal=longest, ticks=5)
    statuses = messages(run, ExecStatus)
    assert [codec.decode(TOPICS["status"], codec.encode(status)) for status in statuses] == statuses
    assert statuses[-1].goal == longest


def test_a_goal_with_half_a_character_is_refused_as_no_status_carries_it():
    refusal = check_goal(line_context(), "(visited a) ; \udcff")  # of a command line with the byte 0xff
    assert refusal == Cause(Reason.GOAL_INVALID, "goal:1:15: an invisible character, U+DCFF")


def moved_in_tick_6(n, given, x):
    return Inputs((odometry(n * TICK, x, n, 0.3 if n >= 6 else 0.0), driver(n * TICK)), given.goal)


def test_place_that_moves_redirects_the_running_action():
    run = list(drive(line_context(), goal="(visited a)", world=moved_in_tick_6))
    assert run[-1][0].task.result == "achieved"
    assert run[-1][2] == pytest.approx(0.8, abs=0.06)
    finished = messages(run, ActionFinished)
    assert len(finished) == 1
    assert finished[0].actual_s > 1.5, "its clock goes on"


@pytest.mark.parametrize("checks", [200, 10])
def test_predictions_of_a_redirected_action_do_not_count_the_ticks_that_its_decision_took(checks):
    run = list(drive(line_context(), goal="(visited a)", world=moved_in_tick_6, checks=checks))
    (finished,) = messages(run, ActionFinished)
    assert len(messages(run, Subgoals)) == 2
    assert finished.predicted_s == pytest.approx(finished.actual_s)


def test_nor_do_they_count_the_time_in_which_the_executive_held_before_it_decided():
    places = {"home": {"x": 0.0}, "a": {"x": 2.0}, "b": {"x": 1.0}}

    def world(n, given, x):
        seen = (odometry(n * TICK, x, n, 0.3 if n >= 20 else 0.0),) if not 22 <= n < 60 else ()
        return Inputs((*seen, driver(n * TICK)), given.goal)

    drives = drive(
        line_context(places=places), "(visited a)", world=world, checks=lambda n: 200 if n < 20 or n > 60 else 0
    )
    run = list(drives)
    (finished,) = messages(run, ActionFinished)
    assert len(messages(run, Subgoals)) == 2
    assert finished.predicted_s == pytest.approx(finished.actual_s, abs=0.3)


@pytest.mark.promise("P11")
def test_stopping_publishes_a_zero_command_and_disarms_the_driver():
    def world(n, given, x):
        return dataclasses.replace(given, stopping=n == 6)

    run = list(drive(line_context(), world=world, ticks=6))
    last = [output.message for output in run[-1][1]]
    assert run[4][0].command[0] > 0
    assert VelocityCommand(6 * TICK, 0.0, 0.0) == last[0]
    assert ArmRequest(arm=False, reset=False, sender=SENDER, epoch=7) in last


@pytest.mark.promise("P26")
def test_three_overruns_in_a_second_hold_the_robot():
    def world(n, given, x):
        return dataclasses.replace(given, skipped=1 if n in (5, 6, 7) else 0)

    run = list(drive(line_context(), world=world, ticks=60))
    assert run[6][0].mode is Mode.HOLDING
    assert run[6][0].cause == Cause(Reason.OVERRUNS, "3 in a second")
    assert run[-1][0].task.result == "achieved"


@pytest.mark.promise("P22")
def test_clock_that_goes_back_holds_for_that_tick():
    context = line_context()
    state = initial_state(context)
    for n in (1, 2, 3):
        state, _ = step(context, state, n * TICK, inputs(n * TICK, 0.0, GOAL if n == 1 else ""), CheckBudget(99))
    assert state.command[0] > 0
    state, _ = step(context, state, TICK, Inputs(), CheckBudget(99))
    assert state.mode is Mode.HOLDING
    assert state.command == (0.0,)
    assert state.now_ns == 3 * TICK


@pytest.mark.parametrize(
    ("mode", "now", "expected"),
    [
        (Mode.READY, Conditions(goal_active=True), (Mode.EXECUTING, None)),
        (Mode.EXECUTING, Conditions(hold=HOLD, goal_active=True), (Mode.HOLDING, HOLD)),
        (Mode.READY, Conditions(hold=HOLD), (Mode.READY, None)),
        (Mode.HOLDING, Conditions(goal_active=True), (Mode.EXECUTING, None)),
        (Mode.EXECUTING, Conditions(disarmed=DISARMED, hold=HOLD, goal_active=True), (Mode.DISARMED, DISARMED)),
        (Mode.EXECUTING, Conditions(fault=FAULT, disarmed=DISARMED), (Mode.FAULT, FAULT)),
        (Mode.FAULT, Conditions(goal_active=True), (Mode.FAULT, None)),
        (Mode.EXECUTING, Conditions(), (Mode.READY, None)),
    ],
)
def test_mode_table(mode, now, expected):
    assert next_mode(mode, now) == expected


@pytest.mark.promise("P19")
@pytest.mark.parametrize(
    ("command", "expected"),
    [
        ((0.7, 0.1), (0.5, 0.1)),
        ((-0.7, -3.0), (-0.5, -1.0)),
        ((float("nan"), 0.1), (0.0, 0.0)),
        ((0.1, float("inf")), (0.0, 0.0)),
        ((0.1,), (0.0, 0.0)),
    ],
)
def test_command_guard_refuses_what_is_not_finite_and_clamps_the_rest(command, expected):
    axes = (Axis("v", "m/s", -0.5, 0.5), Axis("omega", "rad/s", -1.0, 1.0))
    assert checked(command, axes)[0] == expected


def test_limits_of_an_axis_may_differ_in_both_directions():
    axes = (Axis("v", "m/s", -0.2, 0.9), Axis("omega", "rad/s", 0.1, 0.3))
    assert checked((-0.5, 0.0), axes) == ((-0.2, 0.1), None)
    assert checked((1.5, 0.4), axes) == ((0.9, 0.3), None)
    assert checked((-0.2, 0.3), axes) == ((-0.2, 0.3), None)


def test_settings_default_to_the_papers_horizon():
    assert Settings().refinement.horizon == 2


def test_action_that_is_superseded_is_reported_as_aborted():
    """The place moves behind a wall: an action of another plan step has to come first."""
    settings = Settings()
    run = list(drive(line_context(settings), ticks=3))
    state, _, _ = run[-1]
    other = dataclasses.replace(state.task.running, step=99)
    state = dataclasses.replace(state, task=dataclasses.replace(state.task, running=other))
    moved = Inputs((odometry(4 * TICK, 0.0, 4, 0.4), driver(4 * TICK)))
    _, outputs = step(line_context(settings), state, 4 * TICK, moved, CheckBudget(2000))
    ended = [output.message for output in outputs if isinstance(output.message, ActionFinished)]
    assert [(f.action, f.outcome, f.action_index) for f in ended] == [("slide", "aborted", 0)]


def test_action_that_is_decided_anew_goes_on_although_the_plan_is_another():
    """The second place is moved on the way there; the new plan begins with a slide to it from elsewhere."""
    context = line_context()

    def anchor(belief, scenario, remembered):
        return (remembered - {("at", "a")}) | {("at", "home")} if belief.shift else remembered

    context.domain.anchor = anchor

    def world(n, given, x):
        return Inputs((odometry(n * TICK, x, n, 0.3 if n >= 16 else 0.0), driver(n * TICK)), given.goal)

    run = list(drive(context, world=world, ticks=70))
    steps = [state.task.running.step for state, _, _ in run if state.task.running is not None]
    ended = messages(run, ActionFinished)
    assert [(f.outcome, f.action_index) for f in ended] == [("done", 0), ("done", 1)]
    assert [number for number, _ in itertools.groupby(steps)] == [1, 2, 1]
    assert ended[1].predicted_s == pytest.approx(ended[1].actual_s, abs=0.4)


def test_action_whose_effects_hold_already_is_done_and_not_aborted():
    context = line_context()

    def anchor(belief, scenario, remembered):
        there = (remembered - {("at", "home")}) | {("at", "a"), ("visited", "a")}
        return there if belief.shift else remembered

    context.domain.anchor = anchor

    run = list(drive(context, goal="(visited a)", world=moved_in_tick_6, ticks=10))
    ended = messages(run, ActionFinished)
    assert [(f.outcome, f.reason) for f in ended] == [("done", Reason.EFFECTS_HOLD)]
    assert run[-1][0].task.result == "achieved"


def test_a_stopped_driver_gets_no_commands_although_it_names_this_executive():
    def world(n, given, x):
        state = dataclasses.replace(driver(n * TICK).message, mode="stopped")
        return Inputs((odometry(n * TICK, x, n), dataclasses.replace(driver(n * TICK), message=state)), given.goal)

    assert messages(list(drive(line_context(), world=world, ticks=5)), VelocityCommand) == []


@pytest.mark.promise("P6")
def test_after_a_stop_planning_starts_again_from_the_robots_place():
    def world(n, given, x):
        return Inputs((odometry(n * TICK, x, n), driver(n * TICK, "stopped" if 6 <= n < 10 else "armed")), given.goal)

    run = list(drive(line_context(), world=world))
    assert run[5][0].task.running is None
    ways = [
        (output.message.way, state.tick) for state, outputs, _ in run for output in outputs if output.topic == "plan"
    ]
    assert ways[1] == ("searched", 10)
    assert run[-1][0].task.result == "achieved"


@pytest.mark.promise("P6")
@pytest.mark.parametrize("between", [[], ["estopped"]], ids=["unheard", "heard in the same tick"])
def test_nothing_outlasts_a_stop_that_came_and_went_while_the_executive_stood_still(between):
    """Its driver is armed when it goes on, as before; only that no command has passed since arming tells."""

    def told(n, mode, stamp_ns):
        sample = driver(n * TICK, mode)
        return dataclasses.replace(sample, message=dataclasses.replace(sample.message, command_stamp_ns=stamp_ns))

    def world(n, given, x):
        armed = told(n, "armed", 0 if n in (1, 6) else n * TICK)
        states = [*(told(n, mode, 5 * TICK) for mode in between if n == 6), armed]
        return Inputs((odometry(n * TICK, x, n), *states), given.goal)

    run = list(drive(line_context(), world=world))
    assert run[4][0].task.running is not None
    stopped, outputs, _ = run[5]
    assert (stopped.mode, stopped.task.running, stopped.task.decision) == (Mode.DISARMED, None, None)
    assert not [output for output in outputs if isinstance(output.message, VelocityCommand)]
    ways = [
        (output.message.way, state.tick) for state, outputs, _ in run for output in outputs if output.topic == "plan"
    ]
    assert ways[1] == ("searched", 7)
    assert run[-1][0].task.result == "achieved"


@pytest.mark.promise("P6")
@pytest.mark.parametrize(("stood", "goes_on"), [(9, True), (10, False), (30, False)])
def test_nothing_outlasts_a_second_without_a_command_whether_or_not_the_driver_echoes_any(stood, goes_on):
    """Its guard has stopped the robot, which people may have carried, and have armed again since."""
    context, x = line_context(), 0.0
    state = initial_state(context)
    for n in (*range(1, 6), *range(5 + stood, 10 + stood)):
        state, outputs = step(context, state, n * TICK, inputs(n * TICK, x, GOAL if n == 1 else ""), CheckBudget(200))
        x += 0.1 * state.command[0]
        if n == 5 + stood:
            assert (state.task.running is not None) is goes_on
            assert any(isinstance(output.message, VelocityCommand) for output in outputs) is goes_on
    assert state.task.running is not None
    assert state.task.finished == (not goes_on)


@pytest.mark.promise("P6")
def test_a_decision_that_no_action_has_begun_yet_does_not_outlast_a_stop():
    """A person carries the robot meanwhile: what was decided for the old place is not driven from the new one."""
    first = next(n for n, (state, _, _) in enumerate(drive(line_context())) if state.task.decision is not None) + 1

    def world(n, given, x):
        at = x if n <= first else x + 0.8
        return Inputs(
            (odometry(n * TICK, at, n), driver(n * TICK, "stopped" if first < n < 10 else "armed")), given.goal
        )

    run = list(drive(line_context(), goal="(visited b)", world=world))
    assert run[first - 1][0].task.decision is not None
    assert run[first - 1][0].task.running is None
    assert all(state.task.decision is None and state.deliberation is None for state, _, _ in run[first:9])
    begun = next(state.task.running for state, _, _ in run[first:] if state.task.running is not None)
    assert begun.parameters[0] == pytest.approx(0.8)


@pytest.mark.promise("P6")
def test_time_in_which_the_executive_holds_is_no_time_of_the_action():
    def world(n, given, x):
        return Inputs(tuple(s for s in given.samples if not s.key.endswith("odom"))) if 8 <= n < 160 else given

    run = list(drive(line_context(), world=world, ticks=220))
    finished = messages(run, ActionFinished)
    assert [f.outcome for f in finished] == ["done", "done"]
    assert finished[0].actual_s < 2.5
    assert run[-1][0].task.result == "achieved"


def test_arming_is_requested_again_only_while_the_same_start_of_the_driver_stays_silent():
    def world(n, given, x):
        state = driver(n * TICK, "disarmed", 7 if n < 14 else 8, accepted=0)
        return Inputs((odometry(n * TICK, x, n), state), given.goal)

    run = list(drive(line_context(), world=world, ticks=30))
    requested = [
        state.tick for state, outputs, _ in run for output in outputs if isinstance(output.message, ArmRequest)
    ]
    assert requested == [1, 7, 13]


def test_a_driver_that_never_gives_leave_is_asked_less_often_in_the_end():
    def world(n, given, x):
        return Inputs((odometry(n * TICK, x, n), driver(n * TICK, "disarmed", accepted=0)), given.goal)

    run = list(drive(line_context(), world=world, ticks=300))
    asked = [state.tick for state, outputs, _ in run for each in outputs if isinstance(each.message, ArmRequest)]
    assert {later - earlier for earlier, later in pairwise(asked[:20])} == {6}
    assert {later - earlier for earlier, later in pairwise(asked[19:])} == {51}
    assert len(asked) == 23


@pytest.mark.parametrize("mode", ["stopped", "estopped"])
def test_arming_is_never_requested_of_a_driver_that_was_stopped_before_this_executive_came(mode):
    def world(n, given, x):
        return Inputs((odometry(n * TICK, x, n), driver(n * TICK, mode, accepted=0)), given.goal)

    assert messages(list(drive(line_context(), world=world, ticks=20)), ArmRequest) == []


def test_arming_is_requested_once_of_a_driver_that_has_moved():
    def world(n, given, x):
        return Inputs((odometry(n * TICK, x, n), driver(n * TICK, "disarmed", accepted=1)), given.goal)

    assert len(messages(list(drive(line_context(), world=world, ticks=20)), ArmRequest)) == 1


def test_the_state_of_another_robots_driver_does_not_count():
    def world(n, given, x):
        other = dataclasses.replace(driver(n * TICK), key="nomad/driver")
        return Inputs((odometry(n * TICK, x, n), driver(n * TICK, "disarmed"), other), given.goal)

    run = list(drive(line_context(), world=world, ticks=10))
    assert messages(run, VelocityCommand) == []
    assert run[-1][0].mode is Mode.DISARMED


def test_a_robot_whose_belief_is_not_ready_holds():
    context = line_context()
    context.domain.ready = lambda belief: belief.x > 0.0
    run = list(drive(context, ticks=20))
    assert (run[-1][0].mode, run[-1][0].cause) == (Mode.HOLDING, Cause(Reason.BELIEF_NOT_READY))
    assert all(state.command == (0.0,) for state, _, _ in run)


def test_robot_coasts_two_ticks_between_actions_and_then_stands():
    context = line_context()
    state, x, commands = initial_state(context), 0.0, []
    for n in range(1, 40):
        given = inputs(n * TICK, x, GOAL if n == 1 else "")
        state, _ = step(context, state, n * TICK, given, CheckBudget(200 if n < 5 else 0))
        commands.append(state.command[0])
        x += 0.1 * state.command[0]
    arrived = commands.index(CREEP_MPS)
    assert commands[arrived : arrived + 4] == [CREEP_MPS, CREEP_MPS, CREEP_MPS, 0.0]


@pytest.mark.promise("P30")
def test_action_whose_support_is_gone_does_not_start():
    def world(n, given, x):
        return Inputs((odometry(n * TICK, x, n, CLOSED if n >= 2 else 0.0), driver(n * TICK)), given.goal)

    run = list(drive(line_context(), world=world, ticks=10))
    assert run[0][0].task.decision is not None
    assert all(state.task.running is None for state, _, _ in run)
    assert run[-1][0].task.result_cause.reason is Reason.UNSOLVABLE


@pytest.mark.promise("P19")
def test_command_that_is_not_finite_fails_the_action_and_is_never_sent():
    context = line_context(places={"home": {"x": 0.0}, "a": {"x": -6.0}, "b": {"x": 1.0}})
    run = list(drive(context, goal="(visited a)", ticks=12))
    ends = [(f.reason, f.detail) for f in messages(run, ActionFinished)]
    assert ends == [(Reason.COMMAND_INVALID, "v is nan")] * 2
    assert all(command.v == 0.0 for command in messages(run, VelocityCommand))


@pytest.mark.promise("P30")
def test_unsound_plan_is_not_executed(monkeypatch):
    class Broken:
        def __init__(self, *arguments):
            pass

        def advance(self, budget):
            plan = planning.Plan("p", (), (planning.Step(1, ("slide", "a", "b"), 1.0),))
            return planning.Result("solved", plan, "", 1, 1)

    monkeypatch.setattr(planning, "Search", Broken)
    run = list(drive(line_context(), ticks=5))
    assert run[-1][0].task.result is Result.FAILED
    assert run[-1][0].task.result_cause.reason is Reason.PLAN_UNSOUND
    assert all(state.command == (0.0,) for state, _, _ in run)


@pytest.mark.promise("P32")
def test_reports_of_a_refinement_without_a_valid_choice_can_be_encoded():
    class Never:
        def predict(self, arguments):
            return np.full(len(arguments), np.nan), np.full(len(arguments), np.nan)

    context = line_context()
    context = dataclasses.replace(context, models=Models({"slide/duration": Never()}, {}))
    run = list(drive(context, ticks=5))
    reports = messages(run, RefinementReport)
    assert reports
    assert all(isinstance(codec.decode(type(report), codec.encode(report)), RefinementReport) for report in reports)
    assert reports[0].best_s == -1.0
