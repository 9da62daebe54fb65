"""Refinement that begins with an earlier answer takes it at once where it is better than greedy, and only there."""

from __future__ import annotations

import numpy as np
import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.refinement import Refinement
from tests.support.synthetic_models import GO, MODELS, PI, sequence

SETTINGS = RefinementSettings(arrival_spread=(), certify_checks=0)
HAIRPIN = sequence(
    [GO, GO],
    [{"x": 0.0, "y": 0.0, "phi": 0.0, "v": 0.0}, {"x": 2.0, "y": 0.0}, {"x": 0.0, "y": 0.5, "phi": PI, "v": 0.0}],
)


def begun(start=None, seed=7, checks=1):
    refinement = Refinement(HAIRPIN, MODELS, SETTINGS, np.random.default_rng(seed), start)
    refinement.advance(CheckBudget(checks))
    return refinement


@pytest.fixture(scope="module")
def searched():
    refinement = begun(seed=1, checks=2000)
    assert refinement.finished
    greedy = begun().choice
    assert refinement.choice.total_s < greedy.total_s - 0.3, "else the tests below show nothing"
    return refinement.choice


def test_the_first_check_answers_with_a_start_that_is_better_than_greedy(searched):
    found = begun(searched.values).choice
    assert found.values == searched.values
    assert found.total_s == pytest.approx(searched.total_s)


def test_a_start_that_is_worse_than_greedy_is_not_taken():
    greedy = begun().choice
    worst = {i: HAIRPIN.variables[i].upper for i in greedy.values}
    assert begun(worst).choice == greedy


def test_a_start_that_is_hardly_better_than_greedy_is_not_taken(searched):
    greedy = begun().choice
    shares = np.linspace(0, 1, 200)
    between = [{i: g + a * (searched.values[i] - g) for i, g in greedy.values.items()} for a in shares]
    answers = [begun(start).choice for start in between]
    kept = [answer == greedy for answer in answers]
    assert kept[0]
    assert not kept[-1]
    taken = [answer.total_s for answer, same in zip(answers, kept, strict=True) if not same]
    assert max(taken) < greedy.total_s - SETTINGS.gain_k_std * np.sqrt(2 * np.sum(np.square(greedy.std_s)))


def test_a_search_with_a_start_ends_no_worse(searched):
    start = {i: value + 0.01 for i, value in searched.values.items()}
    assert begun(HAIRPIN.values_of(named(start)), checks=2000).choice.total_s <= searched.total_s + SETTINGS.worth_s


def test_values_out_of_range_or_of_other_places_are_no_start(searched):
    known = named(searched.values)
    assert HAIRPIN.values_of(known) == searched.values
    assert HAIRPIN.values_of({**known, ("pos1", "v"): 99.0}).keys() == searched.values.keys() - {by_name("pos1", "v")}
    assert HAIRPIN.values_of({**known, ("pos1", "v"): float("nan")}).keys() < searched.values.keys()
    assert HAIRPIN.values_of({("elsewhere", "v"): 0.1, ("pos0", "x"): 0.0}) == {}


def named(values):
    return {(HAIRPIN.variables[i].label, HAIRPIN.variables[i].quantity): value for i, value in values.items()}


def by_name(label, quantity):
    return next(v.id for v in HAIRPIN.variables if (v.label, v.quantity) == (label, quantity))
