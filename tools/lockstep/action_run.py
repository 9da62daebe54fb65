"""Runs of single actions in lock-step: body, belief and controller in one process.

They yield the random episodes that action models learn from (paper 5.1). `run.py` runs the whole executive.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.outlet import at_rest, completed
from tailor.executive.interfaces.values import Array
from tailor.schemas.installed import part, spec_of
from tailor.simnodes.body import Body
from tailor.tools.lockstep.action_log import ActionLog, ActionRun
from tailor.tools.lockstep.readings import newest
from tailor.tools.lockstep.task_sampler import sampler_of

PERIOD_NS = 100_000_000  # 10 Hz
TIME_LIMIT_S = 40.0  # an action that takes longer has failed


def sample_arguments(domain: Domain, action_name: str, rng: np.random.Generator) -> Array:
    """Random controller arguments of an action, shape (k,), within its declared ranges.

    Raises:
      KeyError: The domain has no such action.
    """
    return sampler_of(domain).sample(domain.actions[action_name], rng)


def with_object(domain: Domain, action_name: str, arguments: Array, rng: np.random.Generator) -> Array:
    """Controller arguments, shape (k,), followed by the row of one random object of the action's context: (k + c,)."""
    return np.concatenate([arguments, sampler_of(domain).context(domain.actions[action_name], arguments, rng)])


def new_body(domain: Domain) -> Body:
    """A simulated body of the domain's robot. Reuse it for every run: making one is slow.

    Raises:
      UsageError: The robot's package has no body.
    """
    body: Body = part(spec_of(domain.name), "body")()
    return body


def run_action(
    body: Body,
    domain: Domain,
    action_name: str,
    arguments: Array,
    rng: np.random.Generator,
    *,
    limit_s: float = TIME_LIMIT_S,
    traced: bool = False,
) -> ActionRun:
    """Run one action from its start state until it is done, has failed, or the time limit is reached.

    Args:
      body: Reset here, with noise from `rng`.
      domain: Provides the controller and the belief filter.
      action_name: An executable action of the domain.
      arguments: Controller arguments, shape (k,): state at the start and at the goal; perhaps followed by one row of
        the action's context, shape (k + c,).
      rng: Source of all noise. Equal arguments and generator states give equal runs, bit for bit.
      limit_s: Limit of the simulated time.
      traced: Also keep beliefs, ground truth and commands.

    Returns:
      The run with its duration, outcome and the training examples of all its ticks.
    """
    action, sampler = domain.actions[action_name], sampler_of(domain)
    arguments, row = np.split(arguments, [len(action.parameters)])
    start = sampler.start(action, arguments, rng)
    if len(row):
        start = start | sampler.context_start(action, row, rng)
    belief = sampler.belief(start, rng)
    body.reset(rng, start)
    log = ActionLog(sampler, action, arguments, row.tolist(), start, traced)
    state: Any = None
    truth, command = body.ground_truth(), at_rest(domain.axes)
    for tick in range(int(limit_s * 1e9) // PERIOD_NS):
        now_ns = tick * PERIOD_NS
        control = action.controller(state, now_ns, belief, arguments)
        command = completed(domain, action, control.command, command)
        log.note(now_ns, belief, truth, command)
        if control.outcome != "running":
            break
        state = control.state
        body.command(command)
        readings = body.advance(PERIOD_NS)
        belief = domain.update(belief, now_ns + PERIOD_NS, newest(readings), command)
        before, truth = truth, body.ground_truth()
        log.moved(readings, before, truth)
    return log.run(control, now_ns)
