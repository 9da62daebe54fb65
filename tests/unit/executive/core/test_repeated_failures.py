"""Whatever an action fails of, it is not repeated for ever."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from tailor.executive.core.action_cycle import MAX_FAILURES, MAX_FRUITLESS
from tailor.executive.core.effects import MAX_SUBGOALS, MAX_UNCONFIRMED
from tailor.executive.core.modes import Mode
from tailor.executive.deliberation.context import MAX_GOAL_BYTES, Settings, make_context
from tailor.executive.interfaces.action import Control, Parameter
from tailor.executive.interfaces.domain import Scenario
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.schemas.codec import decode, encode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import ActionFinished
from tailor.schemas.topics import TOPICS
from tests.support.toy_domain import SENDER, SLIDE, LineDomain, LineModel, inputs, line_context, slide
from tests.unit.executive.core.test_core import TICK, drive, messages


def of(domain):
    return dataclasses.replace(line_context(), domain=domain)


class Complaining(LineDomain):
    """Gives up at once, for another reason each time."""

    def __init__(self):
        slide = dataclasses.replace(SLIDE, controller=self.give_up)
        self.actions = {"slide": slide}

    def give_up(self, state, now_ns, belief, arguments):
        return Control(state, (0.0,), "failed", f"at {now_ns} ns")


@pytest.mark.promise("P30")
def test_time_outs_of_one_action_are_one_failure_whatever_their_limits_were():
    def stuck(n, given, x):
        return inputs(n * TICK, 1.0 * (n > 200), given.goal)  # the second attempt starts nearer, and gets less time

    context = line_context(places={"home": {"x": 0.0}, "a": {"x": 4.0}, "b": {"x": 5.0}})
    run = list(drive(context, goal="(visited a)", world=stuck, ticks=460))
    finished = messages(run, ActionFinished)
    assert len({f.detail for f in finished}) == len(finished) == 2
    assert run[-1][0].mode is Mode.FAULT


@pytest.mark.promise("P30")
def test_failures_that_each_name_another_value_are_a_fault_in_the_end():
    run = list(drive(of(Complaining()), goal="(visited a)", ticks=60))
    finished = messages(run, ActionFinished)
    assert len(finished) == len({f.detail for f in finished}) == MAX_FAILURES
    assert run[-1][0].mode is Mode.FAULT


class Slipping(LineDomain):
    """Its odometry reports what was commanded; it is found where it was each time that this has led 0.2 m astray."""

    def update(self, belief, now_ns, samples, command):
        after = super().update(belief, now_ns, samples, command)
        if not after.seen:
            return after
        astray = abs(belief.x + 0.1 * command[0]) > 0.2
        return dataclasses.replace(
            after, x=0.0 if astray else belief.x + 0.1 * command[0], carried=belief.carried + astray
        )

    def relocations(self, belief):
        return belief.carried


@pytest.mark.promise("P30")
def test_a_robot_that_slips_at_an_obstacle_is_not_found_carried_for_ever():
    run = list(drive(of(Slipping()), goal="(visited b)", ticks=200))
    finished = messages(run, ActionFinished)
    assert [(f.outcome, f.reason) for f in finished] == [("failed", Reason.ROBOT_CARRIED)] * MAX_FAILURES
    state = run[-1][0]
    assert (state.mode, state.command) == (Mode.FAULT, (0.0,))
    assert state.cause == Cause(Reason.REPEATED_FAILURE, "slide: robot carried")


class Losing(LineDomain):
    """Slides to a place well, and is back at home each time that it has failed to lift there, `fails` times."""

    pddl = """
    (define (domain line) (:requirements :strips)
      (:predicates (at ?p) (visited ?p) (place ?p) (lifted ?p))
      (:action slide :parameters (?from ?to)
        :precondition (and (at ?from) (place ?to))
        :effect (and (not (at ?from)) (at ?to) (visited ?to)))
      (:action lift :parameters (?p) :precondition (at ?p) :effect (lifted ?p)))
    """
    executables = {"slide": "slide", "lift": "lift"}

    def __init__(self, fails):
        self.left = fails
        lift = dataclasses.replace(
            SLIDE, name="lift", parameters=(Parameter("x", 0, "x", "m", -10, 100),), controller=self.lift
        )
        self.actions = {"slide": SLIDE, "lift": lift}

    def lift(self, state, now_ns, belief, arguments):
        if not self.left:
            return Control(state, (0.0,), "done")
        if belief.x > 0.1:
            return Control(state, (-0.5,))
        self.left -= 1
        return Control(state, (0.0,), "failed", "slipped")

    def anchor(self, belief, scenario, remembered):
        at = min(scenario.places, key=lambda place: abs(scenario.places[place]["x"] - belief.x))
        return frozenset({*(fact for fact in remembered if fact[0] != "at"), ("at", at)})


class Second:
    """Lifting takes a second."""

    card = {"sha256": "toy"}

    def predict(self, arguments):
        return np.ones(len(arguments)), np.zeros(len(arguments))


def lifting(fails, goal):
    problem = """(define (problem two-places) (:domain line) (:objects home a b)
      (:init (at home) (place a) (place b)) (:goal (lifted a)))"""
    places, domain = {"home": {"x": 0.0}, "a": {"x": 0.5}, "b": {"x": 2.0}}, Losing(fails)
    models = Models({"slide/duration": LineModel(), "lift/duration": Second()}, {})
    domain.actions["lift"] = dataclasses.replace(domain.actions["lift"], duration_model="lift/duration")
    context = make_context(domain, Scenario("lift", problem, places), models, Settings(), SENDER)
    run = list(drive(context, goal=goal, ticks=600, checks=60))
    return [(f.action, f.outcome) for f in messages(run, ActionFinished)], run[-1][0]


@pytest.mark.promise("P30")
def test_an_action_is_not_approached_for_ever_that_fails_after_each_approach():
    """Each approach counted as a success: a ball that was taken away was approached and sought for 75 s."""
    ends, state = lifting(10**6, "(lifted a)")
    assert ends == [("slide", "done"), ("lift", "failed")] * MAX_FRUITLESS
    assert (state.mode, state.command) == (Mode.FAULT, (0.0,))
    assert state.cause == Cause(Reason.REPEATED_FAILURE, "lift: controller failed: slipped")


def test_an_action_that_is_done_in_the_end_may_fail_as_often_again():
    ends, state = lifting(MAX_FRUITLESS - 1, "(lifted a)")
    assert ends[-1] == ("lift", "done")
    assert state.task.result == "achieved"
    assert state.task.fruitless == ()


@pytest.mark.parametrize("text", ["x" * 20_000, "\u20ac" * 20_000, "a path \udcff"])
def test_a_cause_that_no_message_can_hold_is_cut(text):
    """The status of a fault was longer than its topic allows: nobody heard the executive any more."""

    class Verbose(Complaining):
        def give_up(self, state, now_ns, belief, arguments):
            return Control(state, (0.0,), "failed", text)

    run = list(drive(of(Verbose()), goal="(visited a)" + " " * (MAX_GOAL_BYTES - 11), ticks=30))
    assert run[-1][0].mode is Mode.FAULT
    sent = [output for _, outputs, _ in run for output in outputs]
    assert {"status", "finished"} <= {output.topic for output in sent}
    for output in sent:
        assert not isinstance(decode(TOPICS[output.topic], encode(output.message)), Rejected)
    assert messages(run, ActionFinished)[-1].detail[:6] == text[:6]


class Stuck(LineDomain):
    """Needs a run-up from behind home, for which a subgoal is asserted, and gives up once it is past home."""

    actions = {
        "slide": dataclasses.replace(
            SLIDE,
            controller=lambda state, now_ns, belief, arguments: (
                Control(state, (0.0,), "failed", "stuck")
                if arguments[1] > belief.x > 0.0
                else slide(state, now_ns, belief, arguments)
            ),
            parameters=tuple(
                dataclasses.replace(p, lower=-2.0, upper=2.0) if p.unit == "m" else p for p in SLIDE.parameters
            ),
            success_model="slide/success",
            subgoal_action="slide",
        )
    }


class RunUp:
    """Success to places behind home, and from there."""

    card = {"sha256": "toy"}

    def probability(self, arguments):
        start, goal = arguments[:, 0], arguments[:, 1]
        return np.where(((goal < -0.3) & (goal > -1.0)) | (start < -0.2), 0.999, 0.001)


@pytest.mark.promise("P30")
def test_a_failure_is_the_same_again_after_a_subgoal_that_was_asserted_before_the_action():
    context = of(Stuck())
    context = dataclasses.replace(context, models=Models(context.models.durations, {"slide/success": RunUp()}))
    run = list(drive(context, goal="(visited a)", ticks=400, checks=600))
    finished = messages(run, ActionFinished)
    assert [f.outcome for f in finished] == ["done", "failed", "done", "failed"]
    assert run[-1][0].cause == Cause(Reason.REPEATED_FAILURE, "slide: controller failed: stuck")


class Deluded(LineDomain):
    """Takes itself for behind home at once, where it never goes."""

    actions = {
        "slide": dataclasses.replace(
            Stuck.actions["slide"], controller=lambda state, now_ns, belief, arguments: Control(state, (0.0,), "done")
        )
    }


@pytest.mark.promise("P30")
def test_subgoals_are_not_reached_for_ever_before_an_action_that_never_begins():
    context = of(Deluded())
    context = dataclasses.replace(context, models=Models(context.models.durations, {"slide/success": RunUp()}))
    run = list(drive(context, goal="(visited a)", ticks=400, checks=600))
    assert [f.outcome for f in messages(run, ActionFinished)] == ["done"] * MAX_SUBGOALS
    assert run[-1][0].cause == Cause(
        Reason.REPEATED_FAILURE,
        f"slide home a: {MAX_SUBGOALS} subgoals reached in a row, and it is still predicted to fail",
    )
    assert run[-1][0].command == (0.0,)


class Forgetful(LineDomain):
    """Never observes that a place was visited."""

    def anchor(self, belief, scenario, remembered):
        return frozenset(fact for fact in remembered if fact[0] != "visited")


@pytest.mark.promise("P30")
def test_an_action_whose_effect_is_never_observed_is_a_fault_and_not_repeated_for_ever():
    domain = Forgetful()
    domain.actions = {"slide": dataclasses.replace(SLIDE, controller=done_in_motion)}
    run = list(drive(of(domain), goal="(visited a)", ticks=400))
    finished = messages(run, ActionFinished)
    assert {f.outcome for f in finished} == {"done"}
    state = run[-1][0]
    assert state.mode is Mode.FAULT
    assert state.cause == Cause(
        Reason.REPEATED_FAILURE, f"slide a a: done {MAX_UNCONFIRMED} times, and (visited a) is not observed"
    )
    assert state.command == (0.0,)
    faulty = next(step[0] for step in run if step[0].fault is not None)
    assert faulty.mode is Mode.EXECUTING, "the tick in which it is found"
    assert faulty.command == (0.0,)


def done_in_motion(state, now_ns, belief, arguments):
    return Control(state, (0.5,), "done")
