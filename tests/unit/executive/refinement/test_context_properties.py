"""Context of an action: the order of its objects has no effect, more of them never help, and bounds stay sound."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.assertion.assertion import Assertion
from tailor.executive.refinement.certificates.certificate import Certificate, certificate
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.objective.stage_models import models_of
from tailor.executive.refinement.refinement import Refinement
from tests.property import examples
from tests.property.test_stage_bounds import assert_no_stage_costs_less
from tests.support.random_trees import Trees
from tests.support.synthetic_models import DRIBBLE
from tests.unit.executive.refinement.synthetic_context import APPROACH_AROUND, BESIDE, CONTEXT, GO_AROUND, beside

START = {"x": -2.0, "y": 0.0, "phi": 0.0, "v": 0.0}
BALL = {"x": 1.0, "y": 0.0, "v": (0.0, 0.3)}
TARGET = {"x": 0.0, "y": 1.5, "phi": 2.6, "v": 0.0}
seeds = st.integers(0, 2**32 - 1)
discs = st.lists(st.tuples(st.floats(-2.5, 2.5), st.floats(-2, 2), st.floats(0.05, 0.3)), min_size=1, max_size=4)


def decision(belief) -> tuple:
    """Everything that a deliberation decides: the sequence and the choice of its free parameters."""
    chosen, rng = RefinementSettings(checks_max=40, certify_checks=0), np.random.default_rng(7)
    given_sequence = beside(belief, [APPROACH_AROUND, DRIBBLE], [START, BALL, TARGET])
    sequence = Assertion(given_sequence, BESIDE, chosen, rng).advance(CheckBudget(2000))
    if not isinstance(sequence, ActionSequence):
        return (sequence,)
    search = Refinement(sequence, BESIDE, chosen, rng)
    search.advance(CheckBudget(60))
    return sequence, search.choice


@settings(max_examples=10, deadline=None)
@given(discs, st.randoms(use_true_random=False))
def test_order_of_the_objects_changes_no_bit_of_the_decision(belief, order):
    permuted = list(belief)
    order.shuffle(permuted)
    assert decision(belief) == decision(permuted)


@settings(max_examples=100, deadline=None)
@given(discs, discs, seeds)
def test_more_objects_never_raise_success(few, more, seed):
    rng = np.random.default_rng(seed)
    arguments = rng.uniform([-3, -2, -3, 0] * 2, [3, 2, 3, 0.6] * 2, (50, 8))
    success = []
    for belief in (few, [*few, *more]):
        instance = beside(belief, [APPROACH_AROUND], [START, BALL]).actions[0]
        success.append(models_of(instance, BESIDE, RefinementSettings()).success.probability(arguments))
    assert (success[1] <= success[0] + 1e-12).all()
    assert (success[1] >= 0).all()


def learned(seed: int) -> Models:
    """Random trees in place of learned models, with a feature space of one obstacle for the context."""
    return Models(
        {"goToPose/duration": Trees.random(seed, trees=2), "dribbleBall/duration": Trees.random(seed + 1, trees=1)},
        {
            "goToPose/success": Trees.random(seed + 2, trees=2, success=True),
            "goToPose/clearance": Trees.random(seed + 3, "one-obstacle", trees=3, success=True),
        },
    )


def task(
    belief, seed: int, p_fail_max: float = 1.0, spread: bool = True
) -> tuple[SequenceObjective, RefinementSettings]:
    default = RefinementSettings()
    chosen = replace(
        default,
        horizon=9,
        p_fail_max=p_fail_max,
        arrival_spread=default.arrival_spread if spread else (),
        certify_checks=10_000,
    )
    places = [START, {}, BALL, TARGET]
    given_sequence = beside(belief, [GO_AROUND, APPROACH_AROUND, DRIBBLE], places)
    return SequenceObjective(given_sequence.actions, given_sequence.variables, learned(seed), chosen), chosen


@settings(max_examples=25, deadline=None)
@given(discs, seeds, st.booleans(), st.sampled_from([0.9, 1.0]))
def test_no_values_in_a_pair_of_boxes_cost_less_than_the_bound_beside_objects(belief, seed, spread, p_fail_max):
    rng = np.random.default_rng(seed)
    cost, chosen = task(belief, seed, p_fail_max, spread)
    centre, half = cost.ranges.draw(1, rng)[0], cost.ranges.width * 10.0 ** rng.uniform(-4, 0, cost.ranges.count)
    lower = np.clip(centre - half, cost.ranges.lower, cost.ranges.upper)
    upper = np.clip(centre + half, cost.ranges.lower, cost.ranges.upper)
    share = rng.choice([0.0, 1.0, np.nan], (200, cost.ranges.count))
    inside = lower + np.where(np.isnan(share), rng.random(share.shape), share) * (upper - lower)
    assert_no_stage_costs_less(cost, chosen, lower, upper, inside)


@examples(5, 15)
def test_no_choice_beside_objects_costs_less_than_the_certificate_proves(count):
    @settings(max_examples=count, deadline=None)
    @given(discs, seeds)
    def holds(belief, seed):
        cost, chosen = task(belief, seed)
        drawn = cost.ranges.draw(3000, np.random.default_rng(seed))
        best = drawn[int(np.argmin(cost(drawn)))]
        proof = certificate(cost, best, chosen)
        assert isinstance(proof, Certificate)
        proof.advance(CheckBudget(40))
        assert proof.bound <= cost(drawn).min()
        assert len(CONTEXT.columns) == 3

    holds()
