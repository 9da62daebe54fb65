"""What a plan costs when plans are compared: nearly what it costs when it is executed, refined."""

from dataclasses import replace

import numpy as np
import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.plan_choice import PlanScore
from tailor.executive.refinement.refinement import Refinement
from tests.support.synthetic_models import ConeSuccess, PoseDuration, approach_dribble

# turning at the ball costs little before dribbling, and much in it
MODELS = Models(
    {"goToPose/duration": PoseDuration(0.2), "dribbleBall/duration": PoseDuration(2.0)},
    {"goToPose/success": ConeSuccess(3.0)},
)
SETTINGS = RefinementSettings(arrival_spread=(), horizon=2)


def score(checks=1000, models=MODELS, settings=SETTINGS):
    running = PlanScore(approach_dribble(), models, settings, np.random.default_rng(0))
    while (cost_s := running.advance(CheckBudget(checks))) is None:
        pass
    return cost_s


def test_actions_that_depend_on_each_other_are_judged_together():
    """Where the ball is best approached alone, dribbling it begins with a turn."""
    refinement = Refinement(approach_dribble(), MODELS, SETTINGS, np.random.default_rng(0))
    refinement.advance(CheckBudget(2000))
    report = refinement.report()
    assert report.best_s < 0.95 * report.greedy_s
    assert score() == pytest.approx(report.best_s, rel=0.02)


def test_the_cost_is_the_same_however_the_work_is_divided():
    assert score() == score(checks=1)


def test_energy_costs_its_weight():
    """Each joule of an action that takes as many as seconds costs two seconds: three times its duration in all."""
    energies = {"goToPose/energy": PoseDuration(0.2), "dribbleBall/energy": PoseDuration(2.0)}
    models = Models(MODELS.durations | energies, MODELS.successes)
    settings = RefinementSettings(arrival_spread=(), k_std=0.0, risk_cost_s=0.0)
    seconds = score(models=models, settings=settings)
    assert score(models=models, settings=replace(settings, energy_weight=2.0)) == pytest.approx(3 * seconds, rel=0.02)
