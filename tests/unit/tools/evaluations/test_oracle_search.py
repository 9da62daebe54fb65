"""The oracle that searches: stays within ranges, changes one label at a time, and keeps what is fastest."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tailor.schemas import messages as m
from tailor.tools.evaluations.oracles import grid
from tailor.tools.evaluations.oracles import search as oracle_search
from tailor.tools.evaluations.oracles.grid import N_AGAIN
from tailor.tools.evaluations.oracles.search import Search, last_choice
from tailor.tools.evaluations.outcome import Outcome, Variant
from tailor.tools.evaluations.refinement import refinement_rows
from tailor.tools.evaluations.seeds import Seeds
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


def test_a_parameter_that_the_failed_first_runs_lacked_is_searched_from_the_middle_of_its_range():
    search, failed = Search(RANGES, np.random.default_rng(1)), replace(DONE, achieved=False)
    search.note({("a", "x"): 0.9}, failed)
    search.note({}, failed)
    for number in range(60):
        proposed = search.propose(number)
        assert all(lower <= proposed[key] <= upper for key, (lower, upper) in RANGES.items() if key in proposed)
        search.note(proposed, run_of(proposed) if proposed.keys() == RANGES.keys() else failed)
    assert search.best.achieved


def test_where_nothing_is_free_the_first_runs_are_what_is_found(monkeypatch):
    runs = []
    monkeypatch.setattr(oracle_search, "_run", lambda task, variant, seed: (Run(), DOMAIN))
    monkeypatch.setattr(oracle_search, "_pinned", lambda *arguments: runs.append(arguments) or DONE)
    assert oracle_search.search_start(None, Variant("oracle"), 1, 50) == [DONE] * (2 + N_AGAIN)
    assert len(runs) == 2 + N_AGAIN


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


def test_a_goal_that_holds_at_the_start_is_judged_by_the_grid_too():
    one = grid._judged(1, [replace(DONE, duration_s=0.0)], DONE)
    assert (one.ceiling_s, one.greedy_s, one.zero_s) == (0.0, 0.0, 10.0)


@pytest.mark.parametrize("few", [True, False])
def test_the_oracle_has_the_settings_of_the_runs_that_it_is_compared_with(few, monkeypatch):
    """A ceiling of runs that may not risk what refined runs may, say, would be none."""
    seen = []
    done = replace(DONE, free=(("ball", "phi", -3.0, 3.0, 0.0),))
    found = {name: {seed: replace(done, seed=seed) for seed in (5, 6)} for name in ("h1", "h3")}
    monkeypatch.setattr(refinement_rows, "MAX_GRID", 1000 if few else 1)
    monkeypatch.setattr(refinement_rows, "simulate_choices", lambda *words: seen.append(words[3]) or [])
    monkeypatch.setattr(refinement_rows, "search_choices", lambda *words: seen.append(words[2]) or ([], []))
    flags = SimpleNamespace(
        refinement=["risk_cost_s=20", "p_fail_max=0.15"], horizon=[3], oracle=2, oracle_runs=4, points=6,
        episodes=2, profile="", zoo="", tick_ms=0.0, jobs=1, store=None,
    )  # fmt: skip
    refinement_rows._oracle("approach", "soccer", Seeds(5, {}), found, flags)
    (settings,) = seen
    assert (settings.horizon, settings.risk_cost_s, settings.p_fail_max) == (3, 20.0, 0.15)
