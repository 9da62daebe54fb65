"""A required sensor below 60 % of its rate: the running action goes on, no other one starts."""

from __future__ import annotations

import dataclasses

import pytest

from tailor.executive.core.modes import Mode
from tailor.executive.core.sensing.streams import slow_topics, with_samples
from tailor.executive.core.state import Inputs
from tailor.executive.core.step import step
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.reasons import Reason
from tailor.schemas.messages import ActionFinished, Odometry, Sample
from tailor.schemas.topics import TOPICS
from tests.support.toy_domain import LineDomain, driver, line_context, odometry
from tests.unit.executive.core.test_core import GOAL, TICK, drive, messages

FAR = {"home": {"x": 0.0}, "a": {"x": 1.5}, "b": {"x": 2.0}}  # the first action takes three seconds


def numbered(number, **changes):
    """A world in which tick n brings the sample of this number."""

    def world(n, given, x):
        sample = dataclasses.replace(odometry(n * TICK, x, n), sequence=number(n), **changes)
        return Inputs((sample, driver(n * TICK)), given.goal)

    return world


def half_rate_between(first, last):
    """50 Hz, but 25 Hz from tick `first` to `last`."""
    return lambda n: 10 * n - 5 * max(0, min(n, last) - first)


@pytest.mark.promise("P21")
def test_at_half_the_rate_the_running_action_ends_and_no_other_one_starts_until_the_rate_is_back():
    half = numbered(lambda n: half_rate_between(3, 60)(n) // 2)
    run = list(drive(line_context(places=FAR), world=half, ticks=120))
    states = [state for state, _, _ in run]
    assert [(f.action, f.outcome) for f in messages(run[:60], ActionFinished)] == [("slide", "done")]
    first_end = next(state.tick for state in states if state.task.finished == 1)
    assert first_end > 30, "slow since tick 13 at the latest"
    assert {state.mode for state in states[:first_end]} == {Mode.EXECUTING}
    assert {state.mode for state in states[first_end:60]} == {Mode.HOLDING}
    assert all(state.command == (0.0,) for state in states[first_end:60])
    assert (states[40].cause.reason, states[40].cause.detail) == (Reason.INPUT_SLOW, "odom at 25 of 50 Hz")
    assert states[-1].task.result == "achieved"


def test_no_action_starts_for_a_goal_that_is_set_while_a_sensor_is_slow():
    def world(n, given, x):
        given = numbered(lambda n: 2 * n)(n, given, x)
        return dataclasses.replace(given, goal=GOAL if n == 20 else "")

    run = list(drive(line_context(), world=world, ticks=40))
    assert run[-1][0].mode is Mode.HOLDING
    assert all(state.task.running is None for state, _, _ in run)


def test_a_decision_that_begins_with_another_action_waits_for_the_rate():
    """As in test_action_that_is_superseded_is_reported_as_aborted, with a slow sensor."""
    context = line_context(places=FAR)
    for numbers, expected in ((lambda n: 5 * n, True), (lambda n: 2 * n, False)):
        *_, (state, _, _) = drive(context, world=numbered(numbers), ticks=12)
        other = dataclasses.replace(state.task.running, step=99)
        state = dataclasses.replace(state, task=dataclasses.replace(state.task, running=other))
        moved = dataclasses.replace(odometry(13 * TICK, 0.4, 13, 0.4), sequence=numbers(13))
        following, _ = step(context, state, 13 * TICK, Inputs((moved, driver(13 * TICK))), CheckBudget(2000))
        assert (following.task.running.step != 99) is expected


@pytest.mark.parametrize(
    ("numbers", "expected"),
    [
        (range(0, 60, 5), ()),
        (range(0, 36, 3), ()),  # 30 Hz: the limit itself
        ((*range(0, 33, 3), 32), ("odom at 29 of 50 Hz",)),
        ([0] * 12, ()),  # unsigned: not judged
        ((0, 1, *range(2, 12)), ("odom at 10 of 50 Hz",)),
        ((90, 91, 92, 93, *range(0, 16, 2)), ()),  # a new start of the sensor, less than a second ago
    ],
)
def test_the_rate_is_judged_by_the_numbers_over_a_second(numbers, expected):
    streams = {}
    for n, number in enumerate(numbers):
        sample = Sample("agilo/odom", None, n * TICK, number, "cd" * 16)
        streams = with_samples(streams, (sample,), n * TICK)
    assert len(streams["agilo/odom"].samples) <= 11
    assert slow_topics({"odom": 50.0}, "agilo", streams, 11 * TICK) == expected


@pytest.mark.parametrize(("nominal_hz", "expected"), [(10.0, ()), (20.0, ("odom at 10 of 20 Hz",))])
def test_a_declared_rate_takes_the_place_of_the_topics(nominal_hz, expected):
    streams = {}
    for n in range(12):
        streams = with_samples(streams, (Sample("agilo/odom", None, n * TICK, n, "cd" * 16),), n * TICK)
    assert slow_topics({"odom": nominal_hz}, "agilo", streams, 11 * TICK) == expected


def test_a_robot_whose_driver_declares_a_lower_rate_is_driven_to_its_goal():
    context = dataclasses.replace(line_context(), sensor_rates_hz={"odom": 10.0})
    *_, (state, _, _) = drive(context, world=numbered(lambda n: n), ticks=120)
    assert state.task.result == "achieved"


def test_another_sender_is_judged_anew():
    streams = {}
    for n in range(12):
        sample = Sample("agilo/odom", None, n * TICK, n, ("cd" if n < 4 else "ef") * 16)
        streams = with_samples(streams, (sample,), n * TICK)
    assert slow_topics({"odom": 50.0}, "agilo", streams, 11 * TICK) == ()


def test_a_sensor_that_ceased_is_judged_by_its_age_alone():
    streams = {}
    for n in range(12):
        streams = with_samples(streams, (Sample("agilo/odom", None, n * TICK, 5 * n, "cd" * 16),), n * TICK)
    assert [slow_topics({"odom": 50.0}, "agilo", with_samples(streams, (), n * TICK), n * TICK) for n in (12, 40)] == [
        (),
        (),
    ]


@pytest.mark.promise("P6")
def test_a_second_sender_of_a_sensor_counts_only_once_the_first_is_silent():
    """As of a simulator that was started twice, or a recording that is replayed beside the robot."""

    def world(n, given, x):
        first, second = odometry(n * TICK, x, n), dataclasses.replace(odometry(n * TICK, 5.0, n), sender="ef" * 16)
        samples = (first,) if n == 1 else (first, second) if n <= 60 else (second,)
        return dataclasses.replace(given, samples=(*samples, driver(n * TICK)))

    run = list(drive(line_context(), world=world, ticks=80))
    states = [state for state, _, _ in run]
    assert max(state.belief.x for state in states[:60]) < 1.1
    assert states[59].task.result == "achieved"
    assert [state.belief.x for state in states[60:]] == [states[59].belief.x] * 5 + [5.0] * 15
    assert states[-1].cause is None or states[-1].cause.reason is not Reason.INPUT_STALE


@pytest.mark.promise("P6")
def test_a_second_sender_of_a_sensor_without_a_limit_counts_once_the_first_is_silent_for_a_second():
    """What a second simulator's camera sees is not where the robot stands; a camera that was restarted is believed."""

    assert TOPICS["opponents"].fresh_s is None

    class Seeing(LineDomain):
        sensors = ("odom", "opponents")

    def world(n, given, x):
        first, second = (
            Sample("agilo/opponents", Odometry(n * TICK, at, 0.0, 0.0, 0.0, 0.0), n * TICK, n, sender * 16)
            for at, sender in ((x, "cd"), (5.0, "ef"))
        )
        samples = (first,) if n == 1 else (first, second) if n <= 60 else (second,)
        return dataclasses.replace(given, samples=(*given.samples, *samples))

    context = dataclasses.replace(line_context(), domain=Seeing())
    states = [state for state, _, _ in drive(context, world=world, ticks=80)]
    assert max(state.belief.x for state in states[:60]) < 1.1
    assert [state.belief.x == 5.0 for state in states[60:]] == [False] * 10 + [True] * 10
