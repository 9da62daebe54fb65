"""Tries each action of a robot's package for a moment, before thousands of its episodes are gathered."""

from __future__ import annotations

import traceback
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from tailor.executive import domains
from tailor.executive.interfaces.domain import Domain
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import part, spec_of
from tailor.schemas.packages.spec import DomainSpec
from tailor.simnodes.body import Body
from tailor.tools.lockstep.action_run import new_body, run_action, sample_arguments

TRIAL_S = 0.3  # of simulated time


def try_actions(name: str, actions: Iterable[str]) -> None:
    """Draw arguments of each action, and run it for `TRIAL_S`.

    Raises:
      UsageError: A part cannot be imported, or code of the package raises; the message names its file and line.
    """
    spec, domain = spec_of(name), domains.load(name)
    for field in ("sampler", "body"):
        part(spec, field)
    try:
        body = new_body(domain)
        for action in actions:
            _try_action(body, domain, action)
    except UsageError:
        raise
    except Exception as error:
        if spec.package.startswith("tailor."):  # a fault of Tailor
            raise
        message = f"{type(error).__name__}: {' '.join(str(error).split())} ({_line_of(error, spec)})"
        raise UsageError(f"the package of {name} cannot gather: {message}") from error


def _try_action(body: Body, domain: Domain, action: str) -> None:
    rng = np.random.default_rng(0)
    arguments, expected = sample_arguments(domain, action, rng), len(domain.actions[action].parameters)
    where = f"sampler of {domain.name}"
    if np.shape(arguments) != (expected,):
        raise UsageError(f"{where}: sample of {action} has the shape {np.shape(arguments)}, expected ({expected},)")
    ticks = run_action(body, domain, action, arguments, rng, limit_s=TRIAL_S).ticks
    if ticks.shape[1:] != (expected,):
        raise UsageError(f"{where}: arguments_now of {action} has the shape {ticks.shape[1:]}, expected ({expected},)")


def _line_of(error: Exception, spec: DomainSpec) -> str:
    """The innermost line of the package that an error came through; else the one that raised it."""
    modules = [written.partition(":")[0] for written in (spec.domain, spec.body, spec.sampler)]
    folders = {Path(found.origin).parent for found in map(find_spec, modules) if found and found.origin}
    lines = traceback.extract_tb(error.__traceback__)
    line = next((each for each in reversed(lines) if Path(each.filename).parent in folders), lines[-1])
    return f"{Path(line.filename).name}, line {line.lineno}"
