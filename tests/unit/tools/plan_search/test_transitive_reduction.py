"""The orderings of a plan from which all others follow, one function for drawings and for unified-planning."""

import random
from dataclasses import replace
from itertools import combinations

import pytest

from tailor.executive.planning import parse_plan
from tailor.tools.plan_search.transitive_reduction import transitive_reduction
from tailor.tools.viewer.bare_orderings import bare_orderings
from tests.support import synthetic_run


def closure(pairs):
    closed = set(pairs)
    while more := {(i, k) for i, j in closed for j2, k in closed if j == j2} - closed:
        closed |= more
    return closed


def test_orderings_that_others_imply_are_left_out():
    assert transitive_reduction([(1, 2), (2, 3), (1, 3), (1, 4)]) == [(1, 2), (1, 4), (2, 3)]


@pytest.mark.parametrize("seed", range(20))
def test_the_least_orderings_with_the_same_closure_are_left_and_sorted(seed):
    rng = random.Random(seed)
    closed = closure(pair for pair in combinations(range(9), 2) if rng.random() < 0.3)
    left = transitive_reduction(closed)
    assert left == sorted(left)
    assert closure(left) == closed
    assert all(closure({*left} - {each}) != closed for each in left)


def test_a_drawing_leaves_out_what_a_causal_link_orders_as_well():
    plan = parse_plan(synthetic_run.PLAN)
    assert {(link.producer, link.consumer) for link in plan.links} >= {(2, 1)}
    assert bare_orderings(plan) == []
    assert bare_orderings(replace(plan, links=())) == [(2, 1)]
