"""A fact that a later step needs is lost while an action runs: the robot plans anew on its way, and brakes where there
is no other plan, unless the percept was wrong, or the action is one that ends first.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.executive.core.course import HALT_NS, LOST_TICKS, SEARCH_TICKS, with_supports_checked
from tailor.executive.core.state import Inputs, initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import Settings, make_context
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.domain import Scenario
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.reasons import Reason
from tailor.schemas.messages import ActionFinished, Odometry, VelocityCommand
from tests.support.toy_domain import PROBLEM, SENDER, SLIDE, LineBelief, LineDomain, LineModel, driver, odometry

TICK = 100_000_000
PLACES = {"home": {"x": 0.0}, "a": {"x": 1.0}, "b": {"x": 2.0}, "c": {"x": -0.4}, "d": {"x": 0.5}}
LOST_FROM = 6


@dataclass(frozen=True, slots=True)
class WatchingBelief(LineBelief):
    lost: bool = False


class WatchingLine(LineDomain):
    """The toy robot, whose drives may end anywhere; it sees whether a fact is lost."""

    actions = {"slide": replace(SLIDE, subgoal_action="slide")}
    fact = ("place", "b")

    def initial_belief(self):
        return WatchingBelief()

    def update(self, belief, now_ns, samples, command):
        lost = belief.lost
        for sample in samples:
            if isinstance(sample.message, Odometry):
                lost = sample.message.phi == 1.0
        return replace(super().update(belief, now_ns, samples, command), lost=lost)

    def anchor(self, belief, scenario, remembered):
        seen = {self.fact} if self.fact[0] == "place" else set()
        return remembered - {self.fact} if belief.lost else remembered | seen


class PatientLine(WatchingLine):
    """The same robot, whose drives are to end first."""

    actions = {"slide": SLIDE}


class ForgetfulLine(WatchingLine):
    """The same robot; where it has been is what its drives change."""

    fact = ("visited", "a")


class RoadLine(WatchingLine):
    """The same robot, which needs roads; the shortest way leads over a, another one over c and d."""

    pddl = """
    (define (domain roads) (:requirements :strips)
      (:predicates (at ?p) (visited ?p) (road ?from ?to))
      (:action slide :parameters (?from ?to)
        :precondition (and (at ?from) (road ?from ?to))
        :effect (and (not (at ?from)) (at ?to) (visited ?to))))
    """
    problem = """
    (define (problem two-ways) (:domain roads) (:objects home a b c d)
      (:init (at home) (road home a) (road a b) (road home c) (road c d) (road d b)) (:goal (visited b)))
    """
    fact = ("road", "a", "b")


def context_of(domain):
    scenario = Scenario("places", getattr(domain, "problem", PROBLEM), PLACES)
    return make_context(domain, scenario, Models({"slide/duration": LineModel()}, {}), Settings(), SENDER)


def run(lost, domain=None, ticks=60, moved=lambda tick: 0.0, checks=lambda tick: 2000, slow=(), goal="", late=()):
    """The states and messages of ticks; `lost` tells at which ticks the fact is not observed.

    `moved` tells how far the places are from where they were, `checks` how many are granted, `slow` when every other
    sample is missing, `late` before which ticks a period was lost.
    """
    context = replace(context_of(domain or WatchingLine()), sensor_rates_hz={"odom": 50.0})
    state, x, found, number = initial_state(context), 0.0, [], 0
    for tick in range(1, ticks + 1):
        number += 2 if tick in slow else 5
        seen = odometry(tick * TICK, x, tick, moved(tick))
        seen = replace(seen, sequence=number, message=replace(seen.message, phi=float(lost(tick))))
        wanted = (goal or context.problem.goal_text) if tick == 1 else ""
        given = Inputs((seen, driver(tick * TICK)), wanted, skipped=int(tick in late))
        state, outputs = step(context, state, tick * TICK, given, CheckBudget(checks(tick)))
        found.append((state, [output.message for output in outputs]))
        x += 0.1 * state.command[0]
    return found


def ends(found):
    return [
        (tick, message.outcome, message.reason, message.detail)
        for tick, (_, messages) in enumerate(found, 1)
        for message in messages
        if isinstance(message, ActionFinished)
    ]


def reasons(found):
    return [reason for _, _, reason, _ in ends(found)]


def commands(found):
    return [message.v for _, messages in found for message in messages if isinstance(message, VelocityCommand)]


@pytest.mark.promise("P30")
def test_an_action_is_given_up_at_rest_if_no_plan_does_without_the_fact_that_is_lost():
    found = run(lambda tick: tick >= LOST_FROM)
    assert ends(found) == [(LOST_FROM + 2, "aborted", Reason.SUPPORT_LOST, "(place b)")]
    assert commands(found)[LOST_FROM] > 0.4
    assert not any(commands(found)[LOST_FROM + 2 :])
    result = found[-1][0].task.result_cause
    assert result.reason is Reason.UNSOLVABLE


@pytest.mark.promise("P30")
def test_another_plan_is_taken_up_on_the_way_once_a_fact_is_lost_that_a_later_step_needs():
    found = run(lambda tick: tick >= LOST_FROM, RoadLine(), ticks=150)
    assert ends(found)[0] == (LOST_FROM + 2, "aborted", Reason.SUPPORT_LOST, "(road a b)")
    assert reasons(found)[1:] == ["", "", ""]
    assert commands(found)[LOST_FROM] > 0.4
    assert commands(found)[LOST_FROM + 2] < -0.4
    assert found[-1][0].task.result == "achieved"


def test_it_is_decided_anew_at_rest_from_the_facts_of_then():
    found = run(lambda tick: LOST_FROM <= tick < LOST_FROM + 5, ticks=100)
    assert [(outcome, reason) for _, outcome, reason, _ in ends(found)] == [
        ("aborted", Reason.SUPPORT_LOST),
        ("done", ""),
        ("done", ""),
    ]
    assert found[-1][0].task.result == "achieved"
    at_rest = [tick for tick, (state, _) in enumerate(found, 1) if state.halting is not None]
    assert at_rest == list(range(LOST_FROM + 2, LOST_FROM + 2 + HALT_NS // TICK))
    assert all(found[tick - 1][0].task.decision is None for tick in at_rest)


@pytest.mark.parametrize(
    "lost",
    [
        lambda tick: LOST_FROM <= tick < LOST_FROM + 2,
        lambda tick: LOST_FROM <= tick < LOST_FROM + 5 and tick != LOST_FROM + 2,
    ],
)
def test_a_percept_that_is_wrong_for_two_ticks_changes_nothing(lost):
    with_it, without = run(lost), run(lambda tick: False)
    assert commands(with_it) == commands(without)
    assert reasons(with_it) == reasons(without) == ["", ""]


@pytest.mark.parametrize("domain", [PatientLine(), ForgetfulLine()])
def test_actions_end_first_that_may_not_be_left_or_that_change_that_predicate(domain):
    found = run(lambda tick: LOST_FROM <= tick < LOST_FROM + 10 or 25 < tick < 40, domain)
    assert reasons(found)[0] == ""
    assert Reason.SUPPORT_LOST not in reasons(found)


class NearLine(WatchingLine):
    """The same robot; what is lost is the place to which it drives first."""

    fact = ("place", "a")


def test_a_fact_is_watched_that_the_running_action_needs_all_along_and_no_step_any_more_afterwards():
    assert ends(run(lambda tick: tick >= LOST_FROM, NearLine()))[0][2:] == (Reason.SUPPORT_LOST, "(place a)")
    found = run(lambda tick: 26 <= tick < 36, NearLine())
    assert reasons(found) == ["", ""]
    assert ends(found)[0][0] < 26
    assert ends(found)[1][0] > 36


def test_what_a_later_step_brings_about_is_not_watched():
    state = run(lambda tick: False, ticks=LOST_FROM)[-1][0]
    plan = state.task.plan
    later = plan.steps[-1].id
    links = tuple(replace(link, producer=later) for link in plan.links if link.literal.fact == ("place", "b"))
    state = replace(state, belief=replace(state.belief, lost=True))
    changed = replace(state, task=replace(state.task, plan=replace(plan, links=links)))
    counts = [
        with_supports_checked(context_of(WatchingLine()), each).task.running.unsupported for each in (state, changed)
    ]
    assert (len(links), counts) == (1, [1, 0])


class TornLine(RoadLine):
    """The same robot, which always sees one road only of the last two: what comes and goes turns it around."""

    problem = RoadLine.problem.replace("(road home a)", "(road home a) (road a home) (road c home) (road d c)")
    other = ("road", "d", "b")

    def anchor(self, belief, scenario, remembered):
        seen, unseen = (self.other, self.fact) if belief.lost else (self.fact, self.other)
        return (remembered | {seen}) - {unseen}


@pytest.mark.promise("P30")
def test_a_percept_that_comes_and_goes_turns_the_robot_around_once_for_each_fact():
    found = run(lambda tick: tick // LOST_TICKS % 2 == 0, TornLine(), ticks=200)
    assert [detail for _, _, reason, detail in ends(found) if reason] == ["(road d b)", "(road a b)"]
    assert reasons(found).count("") >= 3


def lost_for_good(tick):
    return tick >= LOST_FROM


@pytest.mark.promise("P30")
@pytest.mark.parametrize("late", [-1, 0, 1])
def test_a_fact_is_lost_as_well_if_a_place_moves_at_that_time(late):
    """Another plan was searched for at once, from facts without it: that there was none was forgotten in each tick."""
    found = run(lost_for_good, moved=lambda tick: 0.3 if tick >= LOST_FROM + late else 0.0)
    assert ends(found) == [(LOST_FROM + 2, "aborted", Reason.SUPPORT_LOST, "(place b)")]
    assert not any(commands(found)[LOST_FROM + 2 :])


@pytest.mark.promise("P30")
@pytest.mark.parametrize("domain", [WatchingLine, RoadLine])
def test_a_robot_drives_on_for_a_second_while_another_plan_is_searched_for_and_then_brakes(domain):
    given_up = LOST_FROM + 2 + SEARCH_TICKS
    busy = range(LOST_FROM, given_up + 1)
    found = run(lost_for_good, domain(), ticks=150, checks=lambda tick: 0 if tick in busy else 2000)
    assert ends(found)[0][:3] == (given_up, "aborted", Reason.SUPPORT_LOST)
    assert commands(found)[given_up - 1] > 0.4
    assert commands(found)[given_up] == 0.0
    assert found[-1][0].task.result == ("achieved" if domain is RoadLine else "failed")


def test_a_search_from_before_the_fact_was_missing_is_begun_anew():
    found = run(
        lost_for_good,
        moved=lambda tick: 0.3 if tick >= LOST_FROM - 1 else 0.0,
        checks=lambda tick: 0 if LOST_FROM - 1 <= tick < LOST_FROM + 2 else 2000,
    )
    assert ends(found) == [(LOST_FROM + 2, "aborted", Reason.SUPPORT_LOST, "(place b)")]


def test_a_fact_that_is_seen_again_before_it_is_known_that_no_plan_does_without_it_ends_nothing():
    back = LOST_FROM + 5
    found = run(lambda tick: LOST_FROM <= tick < back, checks=lambda tick: 0 if LOST_FROM <= tick < back else 2000)
    assert commands(found) == commands(run(lambda tick: False))
    assert reasons(found) == ["", ""]


def test_a_plan_that_must_not_begin_yet_as_a_sensor_is_slow_begins_at_rest_once_it_is_not():
    slow = range(2, 20)
    found = run(lambda tick: tick >= 14, RoadLine(), ticks=150, slow=slow)
    assert ends(found)[0] == (16, "aborted", Reason.SUPPORT_LOST, "(road a b)")
    assert not any(commands(found)[17 : slow.stop + 1])
    assert found[-1][0].task.result == "achieved"


def test_a_goal_that_held_when_its_search_began_is_not_achieved_where_it_holds_no_more_at_the_end():
    """An external planner takes seconds to find that there is nothing to do."""
    starved = {"checks": lambda tick: 0 if tick < 20 else 2000, "goal": "(and (place b) (at home))"}
    assert run(lambda tick: tick >= 3, **starved)[-1][0].task.result_cause.reason is Reason.UNSOLVABLE
    assert run(lambda tick: 3 <= tick < 19, **starved)[-1][0].task.result == "achieved"


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(st.booleans(), st.integers(1, 6)), max_size=12), st.sampled_from([WatchingLine, RoadLine]))
def test_whenever_a_fact_is_missing_the_task_ends_and_no_action_for_less_than_three_ticks(spans, domain):
    missing = [lost for lost, ticks in spans for _ in range(ticks)]
    found = run(lambda tick: tick <= len(missing) and missing[tick - 1], domain(), ticks=len(missing) + 160)
    result = found[-1][0].task
    assert result.result == "achieved" or result.result_cause.reason is Reason.UNSOLVABLE
    for tick, outcome, reason, _ in ends(found):
        assert outcome == "done" or (reason == Reason.SUPPORT_LOST and missing[tick - 3 : tick] == [True] * 3)
