"""Boxes of subgoals: pieces inherit the bounds of their box, and are bounded anew where it matters."""

from __future__ import annotations

import numpy as np
import pytest

from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.certificates.box_chain import BoxChain
from tailor.executive.refinement.certificates.boxes import box_of
from tailor.executive.refinement.certificates.joint_bounds import joint_bounds
from tailor.executive.refinement.certificates.stage_bounds import StageBound, stage_bound
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.chain_structure import blocks_of, links_of
from tailor.models.runtime import load_robot
from tailor.tools.benchmarks.refinement.cases import cases

EFFORT = 10**6


@pytest.fixture(scope="module")
def models() -> Models:
    return Models(*load_robot("agilo"))


@pytest.fixture(scope="module")
def tasks(models) -> dict[str, SequenceObjective]:
    """Costs of the benchmark's first task in each case."""
    return {name: drawn[0].objective(models) for name, drawn in cases(models, 1).items()}


def chain_of(cost: SequenceObjective) -> BoxChain:
    """Chain of a benchmark's task with four boxes of each subgoal, all pairs bounded."""
    boxes, bounds = [], []
    blocks = blocks_of(cost.stages)
    assert blocks is not None
    for stage, link, block in zip(cost.stages, links_of(cost.stages, blocks), blocks, strict=True):
        bound = stage_bound(stage, link, RefinementSettings())
        assert isinstance(bound, StageBound)
        bounds.append(bound)
        whole = box_of(cost.ranges.part(block))
        boxes.append(whole.halves(np.ones(len(block))).halves(np.ones(len(block))) if len(block) else whole)
    chain = BoxChain(bounds, boxes, EFFORT)
    list(chain.begin())
    return chain


def split_all(chain: BoxChain, subgoal: int) -> None:
    count, none = len(chain.boxes[subgoal]), np.empty(0, np.intp)
    chain.split(subgoal, none, np.arange(count), np.ones(chain.boxes[subgoal].lower.shape[1]), 2 * count)


def test_splitting_a_box_alone_changes_no_bound(tasks):
    chain = chain_of(tasks["2 free"])
    before = chain.costs().through[-1].min()
    split_all(chain, 0)
    assert chain.costs().through[-1].min() == pytest.approx(before, abs=1e-9)


def test_only_pairs_of_pieces_inherit_their_bounds(tasks):
    chain = chain_of(tasks["4 free"])
    assert not chain.inherits([0, 0, 0])
    chain.split(0, np.array([0, 1]), np.array([2, 3]), np.ones(2), 4)
    assert not chain.inherits([1, 3, 0])
    assert chain.inherits([2, 3, 0])


def test_pairs_on_chains_below_the_limit_are_bounded_anew_and_no_others(tasks):
    chain = chain_of(tasks["4 free"])
    split_all(chain, 1)
    costs = chain.costs()
    cheapest = costs.cheapest()
    least = costs.through[-1].min()
    chain.raise_cheapest(costs, least + 1e-9)
    assert not chain.inherits(cheapest)
    dearest = [int(np.argmax(through)) for through in costs.through]
    assert chain.inherits(dearest)
    assert chain.costs().through[-1].min() >= least - 1e-9


def test_bounds_raised_are_at_least_those_of_the_pieces_themselves(tasks):
    chain = chain_of(tasks["4 free"])
    split_all(chain, 1)
    chain.raise_cheapest(chain.costs(), np.inf)
    before, own = (each.ravel() for each in np.indices((len(chain.boxes[0]), len(chain.boxes[1]))))
    request = chain._bounds[1], chain.boxes[0].part(before), chain.boxes[1].part(own)
    (alone,) = joint_bounds([request])
    assert (chain._pairs[1].middle.ravel() >= alone.middle - 1e-5).all()
