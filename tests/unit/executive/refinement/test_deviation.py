"""The gain that another choice than the greedy one needs: a number for whatever the models predict."""

import math

import pytest

from tailor.executive.refinement.deviation import required_gain_s
from tailor.executive.refinement.objective.choice import Choice
from tailor.executive.refinement.objective.settings import RefinementSettings


def required(*stds_s: float, valid: bool = True) -> float:
    choice = Choice({}, (1.0,) * len(stds_s), stds_s, (0.0,) * len(stds_s), 1.0, valid)
    return required_gain_s(choice, RefinementSettings(gain_min_s=0.25, gain_k_std=0.5))


def test_it_is_a_share_of_the_standard_deviation_of_the_difference():
    assert required(3.0, 4.0) == pytest.approx(0.25 + 0.5 * math.sqrt(2) * 5.0)


def test_any_valid_choice_replaces_one_that_is_not():
    assert required(3.0, 4.0, valid=False) == 0.0


def test_a_huge_standard_deviation_is_no_error():
    assert required(1e300, 1.0) > 1e90
