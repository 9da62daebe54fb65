"""A deliberation at rest finds no way: the task fails once there is none for half a second, not by one percept."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tailor.executive.core.adoption import DOUBT_NS
from tailor.executive.core.modes import Mode
from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.domain import Conflict
from tailor.executive.interfaces.reasons import Reason, Result
from tailor.executive.planning import DEFAULT
from tailor.schemas.messages import PlanReport
from tests.support.toy_domain import line_context
from tests.unit.executive.core.test_core import drive
from tests.unit.executive.core.test_supports import TICK, WatchingLine, commands, run

DOUBTED = DOUBT_NS // TICK


class BlindLine(WatchingLine):
    """The same robot, whose places are nowhere while the fact is lost."""

    def anchor(self, belief, scenario, remembered):
        return remembered

    def value(self, query):
        if query.belief.lost and ("at", query.label) not in query.holds:
            raise Conflict(f"{query.label} is nowhere")
        return super().value(query)


def results(found):
    return [state.task.result for state, _ in found]


def plans(found):
    return [message for _, messages in found for message in messages if isinstance(message, PlanReport)]


@pytest.mark.promise("P30")
@pytest.mark.parametrize("domain", [WatchingLine, BlindLine])
@pytest.mark.parametrize("wrong", [1, 2, DOUBTED])
def test_percepts_that_are_wrong_for_less_than_the_doubt_end_no_task(domain, wrong):
    found = run(lambda tick: tick <= wrong, domain(), ticks=100)
    assert found[-1][0].task.result == "achieved"


@pytest.mark.parametrize(
    ("domain", "reason"), [(WatchingLine, Reason.UNSOLVABLE), (BlindLine, Reason.NOT_INSTANTIABLE)]
)
def test_what_stays_without_a_way_fails_after_the_doubt_and_nothing_moves_before(domain, reason):
    found = run(lambda tick: True, domain())
    assert results(found).count(Result.OPEN) == DOUBTED
    assert found[-1][0].task.result_cause.reason is reason
    assert not any(commands(found))
    assert {state.mode for state, _ in found[: DOUBTED - 1]} == {found[0][0].mode}


def test_an_unsolvable_state_is_searched_once_and_a_place_that_is_nowhere_twice():
    assert len(plans(run(lambda tick: True))) == 1
    assert len(plans(run(lambda tick: True, BlindLine()))) == 2


def test_states_that_change_and_stay_without_a_plan_fail_after_the_doubt():
    found = run(lambda tick: True, Flickering())
    assert results(found).count(Result.OPEN) == DOUBTED
    assert len(plans(found)) == DOUBTED + 1


class Flickering(WatchingLine):
    """The same robot, which sees another thing in every tick."""

    def anchor(self, belief, scenario, remembered):
        known = {fact for fact in super().anchor(belief, scenario, remembered) if fact[0] != "visited"}
        return frozenset(known | ({("visited", "home")} if ("visited", "home") not in remembered else set()))


def test_a_later_failure_is_doubted_anew():
    found = run(lambda tick: tick <= 2 or tick >= 20, ticks=100)
    failed = [tick for tick, result in enumerate(results(found), 1) if result is Result.FAILED]
    waiting = [tick for tick, (state, _) in enumerate(found, 1) if state.task.doubted_until_ns]
    assert waiting[:2] == [1, 2]
    assert failed[0] - waiting[2] == DOUBTED


@pytest.mark.promise("P30")
@pytest.mark.parametrize("domain", [WatchingLine, BlindLine])
def test_time_in_which_the_executive_holds_confirms_no_failure(domain):
    found = run(lambda tick: tick <= 13, domain(), ticks=100, late=(2, 3, 4))
    holding = [tick for tick, (state, _) in enumerate(found, 1) if state.mode is Mode.HOLDING]
    assert holding == list(range(4, 12)), "for longer than the doubt; the percepts are wrong a little longer"
    assert found[-1][0].task.result == "achieved"


def test_a_limit_of_the_search_is_no_matter_of_percepts():
    context = line_context(Settings(planner=replace(DEFAULT, node_limit=1)))
    state = list(drive(context, ticks=2))[-1][0]
    assert state.task.result_cause.reason is Reason.SEARCH_LIMIT
