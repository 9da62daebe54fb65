"""The oracle that searches: stays within ranges, changes one label at a time, and keeps what is fastest."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tailor.schemas import messages as m
from tailor.tools.evaluations.oracles.search import Search, last_choice
from tailor.tools.evaluations.outcome import Outcome
from tailor.tools.lockstep.run import Run

RANGES = {("a", "x"): (0.0, 1.0), ("a", "y"): (-2.0, 2.0), ("b", "x"): (5.0, 6.0)}
START = {("a", "x"): 0.9, ("a", "y"): -1.5, ("b", "x"): 5.0}
DONE = Outcome(1, "oracle", True, 10.0, "achieved", (), (), (), (), False, 0.0, (), ())


def seconds(choice):
    """Shortest at a.x = 0.2, a.y = 1, and at the upper bound of b.x."""
    return 10.0 + abs(choice["a", "x"] - 0.2) + abs(choice["a", "y"] - 1.0) + 6.0 - choice["b", "x"]


def run_of(choice):
    return replace(DONE, duration_s=seconds(choice))


def test_the_search_finds_the_fastest_choice_within_its_ranges():
    search = Search(RANGES, np.random.default_rng(1))
    search.note(START, run_of(START))
    for number in range(120):
        proposed = search.propose(number)
        assert {key[0] for key in RANGES if proposed[key] != search.choice[key]} <= {"ab"[number % 2]}
        assert all(lower <= proposed[key] <= upper for key, (lower, upper) in RANGES.items())
        search.note(proposed, run_of(proposed))
    assert search.best.duration_s == pytest.approx(seconds(search.choice))
    assert search.best.duration_s < 10.2


def test_a_choice_that_fails_or_is_slower_is_not_kept():
    search = Search(RANGES, np.random.default_rng(1))
    search.note(START, run_of(START))
    search.note(search.propose(0), replace(DONE, duration_s=1.0, achieved=False))
    search.note(search.propose(1), replace(DONE, duration_s=99.0))
    assert (search.choice, search.best) == (START, run_of(START))


DOMAIN = SimpleNamespace(actions={"go": SimpleNamespace(parameters=(SimpleNamespace(name="xg", quantity="x"),))})


def test_the_last_free_values_of_a_run_are_its_choice():
    said = [("a", False, 0.3), ("a", False, 0.4), ("a", True, 0.9), ("subgoal1", False, 0.5)]
    subgoals = [
        m.Subgoals(0, k, 2, (m.InstantiatedAction("go", k, False, 1.0, 0.1, (_parameter(*one),)),))
        for k, one in enumerate(said)
    ]
    choice, ranges = last_choice(Run(subgoals=subgoals), DOMAIN)
    assert choice == {("a", "x"): 0.4}
    assert ranges == {("a", "x"): (0.0, 1.0)}


def _parameter(label, bound, value):
    return m.Parameter("xg", 1, label, "m", bound, 0.0, 1.0, value)
