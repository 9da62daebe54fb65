"""Readings that contradict the belief: dropped while they are rare, believed once they are repeated, never stale."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tailor.executive.core.modes import Mode
from tailor.executive.core.sensing.doubts import REPEATED, believed
from tailor.executive.core.state import initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import Settings, make_context
from tailor.executive.interfaces.budget import CheckBudget
from tailor.schemas.messages import Sample
from tests.support.toy_domain import SENDER, inputs, line_context

TICK = 100_000_000
FAR_M = 0.5


def contradicts(sample, before):
    return sample.message == "false"


def outcome(*words, key="agilo/ball"):
    """Which of some readings, one a tick, are believed."""
    doubted, kept = {}, []
    for word in words:
        doubted, now = believed(doubted, (Sample(key, word, 0, 0),), contradicts)
        kept.append(bool(now))
    return kept


def test_what_agrees_is_believed_and_what_contradicts_only_once_it_has_come_three_times_in_a_row():
    assert REPEATED == 3
    assert outcome("true", "false", "false", "false") == [True, False, False, True]
    assert outcome("false", "true", "false", "false", "true") == [False, True, False, False, True]
    assert outcome("false", "false", "false", "false", "false") == [False, False, True, False, False]


def test_readings_of_one_tick_count_each_and_topics_for_themselves():
    ball, pose = (lambda word: Sample("a/ball", word, 0, 0)), (lambda word: Sample("a/pose", word, 0, 0))
    doubted, kept = believed(
        {}, (ball("false"), pose("false"), ball("false"), pose("true"), ball("false")), contradicts
    )
    assert kept == (pose("true"), ball("false"))
    assert doubted == {}
    doubted, kept = believed({"a/ball": 2}, (pose("false"),), contradicts)
    assert (doubted, kept) == ({"a/ball": 2, "a/pose": 1}, ())


def test_a_sample_is_judged_with_those_of_its_tick_that_were_believed_before_it():
    seen = []
    samples = tuple(Sample("a/ball", word, n, n) for n, word in enumerate(("true", "false", "true")))
    believed({}, samples, lambda sample, before: bool(seen.append((sample, before))) or contradicts(sample, before))
    assert seen == [(samples[0], ()), (samples[1], samples[:1]), (samples[2], samples[:1])]


def jumped(before, after):
    return abs(after.x - before.x) > FAR_M


def drive(shown, ticks=8):
    """States of the toy robot at rest; `shown` gives the place that its odometry shows in each tick."""
    plain = line_context()
    doubts = {"odom": jumped}
    context = make_context(plain.domain, plain.scenario, plain.models, Settings(), SENDER, doubts=doubts)
    state, states = initial_state(context), []
    for n in range(1, ticks + 1):
        given = inputs(n * TICK, shown(n))
        given = replace(given, samples=(given.samples[1], given.samples[0]))
        state, _ = step(context, state, n * TICK, given, CheckBudget(100))
        states.append(state)
    return states


@pytest.mark.promise("P6")
def test_a_false_reading_moves_no_belief_and_keeps_its_topic_fresh():
    states = drive(lambda n: 2.0 if n in (4, 6, 7) else 0.0)
    assert [state.belief.x for state in states] == [0.0] * 8
    assert [state.arrivals["agilo/odom"] for state in states] == [n * TICK for n in range(1, 9)]
    assert all(state.mode is not Mode.HOLDING for state in states)


@pytest.mark.promise("P6")
def test_what_was_moved_is_believed_with_the_third_reading():
    assert [state.belief.x for state in drive(lambda n: 2.0 * (n >= 4))] == [0.0] * 5 + [2.0] * 3


def test_a_topic_without_doubt_is_believed_at_once():
    context, state = line_context(), initial_state(line_context())
    for n, x in ((1, 0.0), (2, 2.0)):
        state, _ = step(context, state, n * TICK, inputs(n * TICK, x), CheckBudget(100))
    assert state.belief.x == 2.0
