"""The schedule repeats with its seed, leaves processes alive for long enough, and forgets no fault."""

from __future__ import annotations

from collections import Counter
from itertools import product

import pytest

from tailor.tools.soak.faults.kinds import DEADLY, FAULTS, HARMLESS, SETTLING
from tailor.tools.soak.judging.slopes import SETTLING_S
from tailor.tools.soak.schedule import BEGIN_MIN, END_MIN, schedule

ROBOTS = ("agilo", "powercube")


def planned(seed=0, minutes=60.0, every_s=60.0):
    return schedule(seed, minutes, every_s, ROBOTS, list(HARMLESS), list(DEADLY), SETTLING)


def test_a_seed_gives_one_schedule():
    assert planned(3) == planned(3)
    assert planned(3) != planned(4)


@pytest.mark.parametrize("minutes", [1, 3, 60])
def test_there_is_one_fault_a_minute(minutes):
    assert [int(each.at_s // 60) for each in planned(minutes=minutes)] == list(range(minutes))


@pytest.mark.parametrize("seed", range(5))
def test_no_process_is_ended_while_memory_is_measured(seed):
    measured = [each for each in planned(seed) if BEGIN_MIN * 60 <= each.at_s < (60 - END_MIN) * 60]
    assert len(measured) >= 37
    assert {each.fault for each in measured} <= HARMLESS.keys()


@pytest.mark.parametrize("seed", range(5))
def test_an_hour_sees_every_fault_and_both_robots_alike(seed):
    hour = planned(seed)
    assert {each.fault for each in hour} == FAULTS.keys()
    counts = Counter(each.robot for each in hour)
    assert counts["agilo"] == counts["powercube"]


def test_a_short_soak_draws_any_fault():
    short = planned(minutes=10, every_s=10)
    assert {each.fault for each in short} == FAULTS.keys()


@pytest.mark.parametrize("seed", range(5))
def test_every_robot_settles_before_memory_is_measured(seed):
    begin = [each for each in planned(seed) if BEGIN_MIN * 60 <= each.at_s < BEGIN_MIN * 60 + SETTLING_S]
    assert {(each.fault, each.robot) for each in begin} >= set(product(SETTLING, ROBOTS))
    counts = Counter((each.fault, each.robot) for each in begin)
    assert all(counts[pair] >= 2 for pair in product(SETTLING, ROBOTS))
