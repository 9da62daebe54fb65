"""The executive as a deterministic function: `step(context, state, now_ns, inputs, budget) -> (state, outputs)`.

It has no other inputs: no clock, no bus, no random source. It consumes its state: the ongoing deliberation is resumed
in place, so that each state is used for one step only. A shell may call the two halves itself, to publish the command
before it deliberates; the result is the same.
"""

from __future__ import annotations

from dataclasses import replace

from tailor.executive.core import reporting
from tailor.executive.core.action_cycle import act, interrupted
from tailor.executive.core.course import with_supports_checked
from tailor.executive.core.deliberation_cycle import advance_deliberation, receive_answers
from tailor.executive.core.perception import disarmed, perceive
from tailor.executive.core.state import Inputs, Output, State
from tailor.executive.deliberation.context import Context
from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.outlet import Command, at_rest, messages_of
from tailor.schemas.messages import ArmRequest

REARM_NS = 500_000_000  # a request without an effect is repeated
LATER_NS, OFTEN = 5_000_000_000, 20  # less often after so many: a driver that gave no leave refuses and counts each


def control(context: Context, state: State, now_ns: int, inputs: Inputs) -> tuple[State, tuple[Output, ...]]:
    """First half of a tick: belief, mode, running action, command. Always runs; consumes `state`."""
    before = state.task
    state = perceive(context, state, now_ns, inputs)
    cut_off = interrupted(context, before, state, inputs)
    receive_answers(context, state, inputs)
    state, finished = act(context, state)
    outputs = _commands(context, state, state.command, state.now_ns)
    state, request = _disarm_request(context, state) if inputs.stopping else _arm_request(context, state)
    if request is not None:
        outputs.append(Output("self_arm", request))
    outputs.extend(Output("finished", end) for end in (cut_off, finished) if end is not None)
    return state, tuple(outputs)


def deliberate(context: Context, state: State, budget: Budget) -> tuple[State, tuple[Output, ...]]:
    """Second half of a tick: planning to refinement within the budget, then reports. Consumes `state`."""
    state = with_supports_checked(context, state)
    before = reporting.snapshot(state)
    state = advance_deliberation(context, state, budget)
    return state, reporting.reports(context, state, before)


def step(
    context: Context, state: State, now_ns: int, inputs: Inputs, budget: Budget
) -> tuple[State, tuple[Output, ...]]:
    """One tick. Deterministic; consumes its state.

    Args:
      context: Domain, scenario, models and settings.
      state: The state that the last step returned, or `initial_state`; consumed, not to be used again.
      now_ns: Monotonic time of this tick.
      inputs: What arrived since the last tick.
      budget: Limit of the deliberation; equal numbers of granted checks give equal outputs.

    Returns:
      The next state, and the messages to publish in order: the command first.
    """
    state, first = control(context, state, now_ns, inputs)
    state, rest = deliberate(context, state, budget)
    return state, (*first, *rest)


def at_once_at_rest(context: Context, state: State, now_ns: int) -> tuple[Output, ...]:
    """The zero command, if the driver obeys: for a shell whose tick of this time raised, before it ends."""
    return tuple(_commands(context, state, at_rest(context.domain.axes, state.command), now_ns))


def _commands(context: Context, state: State, command: Command, now_ns: int) -> list[Output]:
    """The messages of a command; none if the driver does not obey."""
    if disarmed(context, state) is not None:
        return []
    messages = messages_of(context.domain, command, context.stamp(now_ns))
    return [Output(topic, message) for topic, message in messages]


def _arm_request(context: Context, state: State) -> tuple[State, ArmRequest | None]:
    """Request to arm, for a driver that has not yet moved; a driver that stopped or restarted is armed by people."""
    arming = state.arming
    driver = arming.driver
    if driver is None or driver.mode != "disarmed" or not state.task.active:
        return state, None
    first_time = arming.requested_epoch == 0
    pause_ns = REARM_NS if arming.requests < OFTEN else LATER_NS
    again = arming.requested_epoch == driver.epoch and state.now_ns - arming.requested_ns > pause_ns
    if not (first_time or (again and driver.accepted == 0)):
        return state, None
    number = arming.requests + 1
    arming = replace(arming, requested_epoch=driver.epoch, requested_ns=state.now_ns, requests=number)
    request = ArmRequest(arm=True, reset=False, sender=context.sender, epoch=driver.epoch)
    return replace(state, arming=arming), request


def _disarm_request(context: Context, state: State) -> tuple[State, ArmRequest | None]:
    """Request to disarm, if the driver obeys this executive."""
    driver = state.arming.driver
    if driver is None or disarmed(context, state) is not None:
        return state, None
    return state, ArmRequest(arm=False, reset=False, sender=context.sender, epoch=driver.epoch)
