"""Grounding and search check the budget after so much work, not only after so many bindings or refined plans."""

from itertools import pairwise

import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import MATCHING, Search, Settings, best_first
from tailor.executive.planning.flaws.ranking import Ranking
from tailor.executive.planning.ground import grounding
from tailor.executive.planning.ground.ground_formula import GroundingLimit
from tailor.executive.planning.ground_plans import new_steps
from tests.support.planning.planning_problems import own, read, solve

DOMAIN = """(define (domain d) (:predicates (p ?x ?y ?z) (g ?x)) (:action make :parameters (?x) :effect (p ?x ?x ?x))
  (:action use :parameters (?x) :precondition (forall (?y ?z) (not (p ?x ?y ?z))) :effect (g ?x)))"""
INSTANCE = 30**2  # steps of grounding that one action takes


class MeteredBudget(CheckBudget):
    """Notes how many steps of grounding were taken before each check."""

    def __init__(self):
        super().__init__(10**9)
        self.steps, self.at_check = 0, [0]

    def spent(self):
        self.at_check.append(self.steps)
        return super().spent()

    def most_between_checks(self):
        return max(after - before for before, after in pairwise(self.at_check))


@pytest.fixture
def metered(monkeypatch):
    budget, real = MeteredBudget(), GroundingLimit.spend

    def counted(limit, steps=1):
        budget.steps += steps
        real(limit, steps)

    monkeypatch.setattr(GroundingLimit, "spend", counted)
    return budget


@pytest.mark.parametrize("bindings", [grounding.MAX_BINDINGS, 0], ids=["all", "reachable"])
def test_quantified_conditions_are_ground_in_several_units_of_the_budget(monkeypatch, metered, bindings):
    monkeypatch.setattr(grounding, "MAX_BINDINGS", bindings)
    objects = " ".join(f"o{n}" for n in range(30))
    domain, problem = read(DOMAIN, f"(define (problem x) (:domain d) (:objects {objects}) (:goal (g o0)))")
    result = Search(domain, problem, Settings(engine="forward", node_limit=1)).advance(metered)
    assert result is not None
    assert metered.at_check[-1] > 30 * INSTANCE
    assert metered.most_between_checks() < grounding.MAX_UNCHECKED + 2 * INSTANCE


FORALL = """(define (domain d) (:predicates (p ?x ?y) (q ?x ?y) (g))
  (:action make :effect (forall (?x ?y) (when (not (q ?x ?y)) (p ?x ?y))))
  (:action use :precondition (forall (?x ?y) (or (not (q ?x ?y)) (p ?x ?y))) :effect (g)))"""


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
def test_one_huge_action_is_made_in_many_units_of_the_budget(metered, ground):
    objects = " ".join(f"o{n}" for n in range(65))
    domain, problem = read(FORALL, f"(define (problem x) (:domain d) (:objects {objects}) (:goal (g)))")
    Search(domain, problem, Settings(ground=ground, engine="pocl", node_limit=1)).advance(metered)
    assert metered.steps > 25_000
    assert metered.most_between_checks() < 2000


def test_schemata_with_too_many_literals_for_variables_are_refused_by_name():
    text = """(define (domain d) (:predicates (p ?x) (q ?x) (g))
      (:action use :precondition (forall (?x) (p ?x)) :effect (and (g) (forall (?x) (q ?x))))
      (:action make :effect (forall (?x) (p ?x))))"""
    objects = " ".join(f"o{n}" for n in range(600))
    domain, problem = read(text, f"(define (problem x) (:domain d) (:objects {objects}) (:goal (g)))")
    result = Search(domain, problem, Settings(ground=False)).advance(CheckBudget(10**9))
    assert result.status == "limit"
    assert result.reason == "600 conditions of 'use' and 601 effects of 'use' are too many for planning with variables"
    assert Search(domain, problem).advance(CheckBudget(10**9)).status == "solved"


MANY_WAYS = """(define (domain d) (:predicates (p ?x) (g)) (:action one :parameters (?x) :effect (p ?x))
  (:action all :parameters (?x ?y) :effect (and (g) (p ?x))))"""


def test_large_plans_are_ranked_in_several_units_of_the_budget(monkeypatch):
    monkeypatch.setattr(best_first, "RANKED_AT_ONCE", 200)
    budget, rank = MeteredBudget(), Ranking.rank

    def counted(ranking, plan, number):
        budget.steps += plan.open_count
        return rank(ranking, plan, number)

    monkeypatch.setattr(Ranking, "rank", counted)
    objects = " ".join(f"o{n}" for n in range(20))
    problem = f"(define (problem x) (:domain d) (:objects {objects}) (:goal (and (g) (forall (?x) (p ?x)))))"
    Search(*read(MANY_WAYS, problem), Settings(engine="pocl", node_limit=2000)).advance(budget)
    assert budget.steps > 10_000
    assert budget.most_between_checks() <= 200 + 10  # a plan may have a condition more than its parent


@pytest.mark.parametrize("name", ["kitchen-reach-s2", "kitchen-durative-s2"])
def test_portions_and_tables_of_links_change_no_plan_and_no_count(monkeypatch, name):
    whole = solve(*own(name), MATCHING)
    monkeypatch.setattr(best_first, "RANKED_AT_ONCE", 1)
    monkeypatch.setattr(new_steps, "MANY_LINKS", 0)
    assert solve(*own(name), MATCHING) == whole
