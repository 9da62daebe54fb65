"""The arm's sampler: episodes begin with gears that have the friction which models are asked for."""

import numpy as np
import pytest

from tailor.executive import domains
from tailor.executive.domains.arm.action_library import REACH
from tailor.simnodes.powercube.body import PowerCubeBody
from tailor.tools.lockstep.action_run import run_action
from tailor.tools.lockstep.samplers.arm import FRICTION, PARAMETERS, ArmSampler, observed_friction


def test_the_body_starts_with_the_friction_of_the_arguments() -> None:
    sampler, body = ArmSampler(), PowerCubeBody()
    ratios = []
    for seed in range(200):
        rng = np.random.default_rng(seed)
        arguments = sampler.sample(REACH, rng)
        body.reset(rng, sampler.start(REACH, arguments, rng))
        ratios.append([observed_friction(gear) / f for gear, f in zip(body.gears, arguments[FRICTION], strict=True)])
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.02)
    assert np.std(ratios) == pytest.approx(PARAMETERS.friction_std, rel=0.2)  # wear, which the start does not decide


def test_random_reaches_have_any_friction_that_models_are_asked_for() -> None:
    lower, upper = REACH.parameters[8].lower, REACH.parameters[8].upper
    drawn = np.array([ArmSampler().sample(REACH, np.random.default_rng(seed))[FRICTION] for seed in range(300)])
    assert lower <= drawn.min() < lower + 0.02
    assert upper - 0.02 < drawn.max() <= upper


def test_examples_hold_the_friction_that_is_believed_on_the_way() -> None:
    rng = np.random.default_rng(3)
    arguments = ArmSampler().sample(REACH, rng)
    run = run_action(PowerCubeBody(), domains.load("arm"), "reach", arguments, rng, traced=True)
    believed = [tick.belief.friction for tick in run.trace]
    assert np.clip(believed, REACH.parameters[8].lower, REACH.parameters[8].upper) == pytest.approx(
        run.ticks[: len(believed), FRICTION]
    )
    assert np.ptp(run.ticks[:, FRICTION], axis=0).max() > 0.0  # it is observed as the joints move
