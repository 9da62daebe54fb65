"""The executive as a pure function: `step(context, state, now_ns, inputs, budget) -> (state, outputs)`.

A shell may call its two halves itself, to send the command before it deliberates; the result is the same.
"""

from __future__ import annotations

from dataclasses import replace

from tailor.executive.core import reporting
from tailor.executive.core.action_cycle import act
from tailor.executive.core.asking import hear_planner
from tailor.executive.core.context import Context
from tailor.executive.core.perception import disarmed, perceive
from tailor.executive.core.state import Inputs, Output, State
from tailor.executive.core.thinking import think
from tailor.executive.interfaces.budget import Budget
from tailor.schemas.messages import ArmRequest

ARM_AGAIN_NS = 500_000_000  # a request that got no answer is repeated


def control(context: Context, state: State, now_ns: int, inputs: Inputs) -> tuple[State, tuple[Output, ...]]:
    """Belief, mode and command: the part of a tick that always runs, and first."""
    state = perceive(context, state, now_ns, inputs)
    hear_planner(context, state, inputs)
    acted = act(context, state)
    state = acted.state
    outputs: list[Output] = []
    if not disarmed(context, state):
        command = context.domain.message(state.command, context.stamp(state.now_ns))
        outputs.append(Output(context.domain.command_topic, command))
    state, request = _disarm_request(context, state) if inputs.stopping else _arm_request(context, state)
    if request is not None:
        outputs.append(Output("arm_request", request))
    if acted.finished is not None:
        outputs.append(Output("finished", acted.finished))
    return state, tuple(outputs)


def deliberate(context: Context, state: State, budget: Budget) -> tuple[State, tuple[Output, ...]]:
    """Planning, instantiation, assertion and refinement, as far as the budget goes; then what to tell of it."""
    before = reporting.snapshot(state)
    state = think(context, state, budget)
    return state, reporting.reports(context, state, before)


def step(
    context: Context, state: State, now_ns: int, inputs: Inputs, budget: Budget
) -> tuple[State, tuple[Output, ...]]:
    """One tick.

    Args:
      context: Domain, scenario, models and settings.
      state: The state that the last step returned; not to be used again.
      now_ns: Monotonic time of this tick.
      inputs: What arrived since the last tick.
      budget: How long deliberation may take.

    Returns:
      The next state, and the messages to publish in order: the command first.
    """
    state, first = control(context, state, now_ns, inputs)
    state, rest = deliberate(context, state, budget)
    return state, (*first, *rest)


def _arm_request(context: Context, state: State) -> tuple[State, ArmRequest | None]:
    """Ask a driver that has never moved for us to arm; one that stopped or restarted waits for people."""
    arming = state.arming
    driver = arming.driver
    if driver is None or driver.mode != "disarmed" or not state.task.active:
        return state, None
    first_time = arming.asked_epoch == 0
    again = arming.asked_epoch == driver.epoch and state.now_ns - arming.asked_ns > ARM_AGAIN_NS
    if not (first_time or (again and driver.accepted == 0)):
        return state, None
    arming = replace(arming, asked_epoch=driver.epoch, asked_ns=state.now_ns)
    request = ArmRequest(arm=True, reset=False, sender=context.sender, epoch=driver.epoch)
    return replace(state, arming=arming), request


def _disarm_request(context: Context, state: State) -> tuple[State, ArmRequest | None]:
    """Let the driver go, if it is ours to let go."""
    driver = state.arming.driver
    if driver is None or disarmed(context, state):
        return state, None
    return state, ArmRequest(arm=False, reset=False, sender=context.sender, epoch=driver.epoch)
