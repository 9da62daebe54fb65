"""Tries each action of a robot's package for a moment, before thousands of its episodes are gathered."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from tailor.executive import domains
from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.outlet import driven_axes
from tailor.executive.interfaces.values import Array
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import part, spec_of
from tailor.schemas.installed.package_errors import blamed_on_package
from tailor.simnodes.body import Body
from tailor.simnodes.world import World
from tailor.tools.lockstep.action_run import new_body, run_action, sample_arguments
from tailor.tools.lockstep.sampler_check import check_sampler
from tailor.tools.lockstep.task_sampler import sampler_of

TRIAL_S = 0.3  # of simulated time


def try_actions(name: str, actions: Iterable[str]) -> None:
    """Draw arguments of each action, and run it for `TRIAL_S`.

    Raises:
      UsageError: A part cannot be imported, or code of the package raises; the message names its file and line.
    """
    spec, domain = spec_of(name), domains.load(name)
    check_sampler(name)
    part(spec, "body")
    with blamed_on_package(spec, f"the package of {name} cannot gather"):
        body = new_body(domain)
        World(body, {}, 0).advance(round(TRIAL_S * 1e9))  # which refuses what are no readings
        for action in actions:
            _try_action(body, domain, action)


def _try_action(body: Body, domain: Domain, action: str) -> None:
    rng = np.random.default_rng(0)
    arguments, expected = sample_arguments(domain, action, rng), len(domain.actions[action].parameters)
    where = f"sampler of {domain.name}"
    if not isinstance(arguments, np.ndarray):
        raise UsageError(f"{where}: sample of {action} returned a {type(arguments).__name__}, expected an array")
    if np.shape(arguments) != (expected,):
        raise UsageError(f"{where}: sample of {action} has the shape {np.shape(arguments)}, expected ({expected},)")
    _check_finite(f"{where}: sample of {action}", domain, action, arguments)
    try_command(domain, action)
    ticks = run_action(body, domain, action, arguments, rng, limit_s=TRIAL_S).ticks
    if ticks.shape[1:] != (expected,):
        raise UsageError(f"{where}: arguments_now of {action} has the shape {ticks.shape[1:]}, expected ({expected},)")
    for tick in ticks:
        _check_finite(f"{where}: arguments_now of {action}", domain, action, tick)


def try_command(domain: Domain, action: str) -> None:
    """Raise UsageError if an action's first command has not one value for each axis that it drives."""
    fault = command_fault(domain, action, np.random.default_rng(0))
    if fault:
        raise UsageError(f"controller of {action}: {fault}")


def command_fault(domain: Domain, name: str, rng: np.random.Generator) -> str:
    """What is wrong with the length of an action's first command from a random start; empty if nothing is."""
    action, sampler, arguments = domain.actions[name], sampler_of(domain), sample_arguments(domain, name, rng)
    belief = sampler.belief(sampler.start(action, arguments, rng), rng)
    command, axes = action.controller(None, 0, belief, arguments).command, driven_axes(domain, action)
    if len(command) == len(axes):
        return ""
    return f"{len(command)} values, expected {len(axes)}: {', '.join(axis.name for axis in axes)}"


def _check_finite(where: str, domain: Domain, action: str, arguments: Array) -> None:
    """Raise UsageError, naming the first parameter that is no number, as where a reading of the body is none."""
    for parameter, value in zip(domain.actions[action].parameters, arguments.tolist(), strict=True):
        if not math.isfinite(value):
            raise UsageError(f"{where} has {parameter.name} = {value}, expected a number")
