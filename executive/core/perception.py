"""First part of a tick: inputs update belief, driver, goal and mode; the mode is decided on one snapshot."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from tailor.executive.core.modes import Conditions, Mode, next_mode
from tailor.executive.core.sensing.doubts import believed
from tailor.executive.core.sensing.freshness import (
    MAX_ROUND_TRIP_NS,
    echo_age_ns,
    is_stale,
    newest_arrivals,
    stale_topics,
)
from tailor.executive.core.sensing.measurements import without_faulty
from tailor.executive.core.sensing.streams import of_known_senders, slow_topics, with_samples
from tailor.executive.core.state import Arming, Inputs, State, Task, undecided
from tailor.executive.deliberation.context import Context, drops_goal
from tailor.executive.interfaces.domain_results import is_ready, measurement_fault, relocations, updated
from tailor.executive.interfaces.outlet import staying
from tailor.executive.interfaces.reasons import Cause, Reason, Result
from tailor.schemas.messages import DriverState, Sample
from tailor.schemas.reason_text import reason_text
from tailor.schemas.topics import key_of

STOOD_NS = 1_000_000_000  # without a tick, and so without a command: guards have stopped a robot long before


def perceive(context: Context, state: State, now_ns: int, inputs: Inputs) -> State:
    """The state with this tick's inputs and the mode that follows from them."""
    unsent = disarmed(context, state) is not None
    backward, now_ns = now_ns < state.now_ns, max(now_ns, state.now_ns)
    passed_ns, second_ago = now_ns - state.now_ns, now_ns - 1_000_000_000
    overruns = (*(t for t in state.overruns_ns if t > second_ago), *((now_ns,) * bool(inputs.skipped)))
    arming = _driver_of(context, state.arming, now_ns, inputs)
    if passed_ns >= STOOD_NS and _was_armed(state.arming):  # without an echo nothing else tells
        arming = replace(arming, rearmed=True)
    state = replace(state, tick=state.tick + 1, now_ns=now_ns, overruns_ns=overruns, arming=arming)
    state = _with_readings(context, state, inputs.samples)
    if unsent and not _stale(context, state):  # arming moves nothing: also no gripper that people have opened by hand
        state = replace(state, command=staying(context.domain, state.belief, state.command))
    if inputs.goal:
        state = _with_goal(context, state, inputs.goal)
    if inputs.stopping:
        state = replace(state, task=replace(state.task, active=False, running=None, decision=None), deliberation=None)
    return _paused(_with_mode(context, state, Cause(Reason.CLOCK_BACKWARD) if backward else None), passed_ns)


def disarmed(context: Context, state: State) -> Cause | None:
    """Cause for which the driver does not obey this executive; None if it does."""
    driver, robot = state.arming.driver, context.domain.robot
    if driver is None or is_stale("driver", state.arming.heard_ns, state.now_ns):
        return Cause(Reason.DRIVER_SILENT, robot)
    if driver.mode != "armed":
        return Cause(Reason.DRIVER_NOT_ARMED, reason_text(driver.mode, reason_text(driver.reason, driver.detail)))
    if driver.armed_sender != context.sender:
        return Cause(Reason.DRIVER_OBEYS_ANOTHER, driver.armed_sender[:8])
    if state.arming.rearmed:
        return Cause(Reason.DRIVER_NOT_ARMED, "disarmed and armed again meanwhile")
    return None


def slow_inputs(context: Context, state: State) -> Cause | None:
    """Cause for which no new action starts; None if all required sensors come at their rates."""
    slow = slow_topics(context.sensor_rates_hz, context.domain.robot, state.streams, state.now_ns)
    return Cause(Reason.INPUT_SLOW, ", ".join(slow)) if slow else None


def _with_readings(context: Context, state: State, samples: tuple[Sample, ...]) -> State:
    """Belief, and age and rate of the sensors: what is no measurement keeps no topic fresh, but its sender known."""
    domain = context.domain
    received = of_known_senders(domain.sensors, domain.robot, state.streams, samples)
    judge = partial(measurement_fault, domain, state.belief)
    measurements, readings = without_faulty(state.measurements, received, state.fastest, judge)
    doubted, kept = believed(state.doubted, readings, partial(_contradicts, context, state))
    belief = updated(domain, state.belief, state.now_ns, kept, state.command)
    return replace(
        state,
        belief=belief,
        doubted=doubted,
        carried=relocations(domain, belief) != relocations(domain, state.belief),
        arrivals=newest_arrivals(state.arrivals, readings),
        streams=with_samples(state.streams, received, state.now_ns),
        measurements=measurements,
    )


def _contradicts(context: Context, state: State, sample: Sample, before: tuple[Sample, ...]) -> bool:
    """Whether a sample moves the belief farther than the world moves; `before` are those of this tick before it."""
    contradicts = context.doubts.get(sample.key)
    if contradicts is None:
        return False
    known = updated(context.domain, state.belief, sample.arrival_ns, before, state.command)
    return contradicts(known, updated(context.domain, known, sample.arrival_ns, (sample,), state.command))


def _driver_of(context: Context, arming: Arming, now_ns: int, inputs: Inputs) -> Arming:
    """The driver's newest state. Another sender counts only once the known one is silent, e.g. after a restart."""
    key, arming = key_of("driver", context.domain.robot), replace(arming, rearmed=False)
    if arming.heard_ns is None:
        arming = replace(arming, heard_ns=now_ns)
    for sample in inputs.samples:
        if sample.key == key and isinstance(sample.message, DriverState):
            first = not arming.driver_sender and arming.driver is None
            if first or sample.sender == arming.driver_sender or is_stale("driver", arming.heard_ns, sample.arrival_ns):
                arming = replace(
                    arming,
                    driver=sample.message,
                    driver_sender=sample.sender,
                    heard_ns=sample.arrival_ns,
                    echo_age_ns=echo_age_ns(sample.message, sample.arrival_ns, context.stamp_offset_ns),
                    rearmed=arming.rearmed or _rearmed(arming.driver, sample.message),
                )
    return arming


def _was_armed(arming: Arming) -> bool:
    return arming.driver is not None and arming.driver.mode == "armed"


def _rearmed(known: DriverState | None, now: DriverState) -> bool:
    """Whether a driver that was armed no longer is, or was armed again: since arming it has passed no command."""
    if known is None or known.mode != "armed":
        return False
    return now.mode != "armed" or (known.command_stamp_ns != 0 and now.command_stamp_ns == 0)


def _with_goal(context: Context, state: State, goal: str) -> State:
    if drops_goal(context, goal):
        return _without_goal(state)
    facts = state.task.facts if state.task.goal else frozenset(context.problem.initial)  # nothing may hold after a goal
    task = Task(goal=goal, active=True, facts=facts, left=state.task.left)
    return replace(state, task=task, deliberation=None, fault=None, mode=Mode.READY)


def _without_goal(state: State) -> State:
    """The open goal dropped with all that was decided for it: nothing moves until another goal is set."""
    if not state.task.active:
        return state
    state = undecided(state)
    task = replace(state.task, active=False, result=Result.CANCELLED)
    return replace(state, task=task, fault=None, mode=Mode.READY)


def _with_mode(context: Context, state: State, clock_fault: Cause | None) -> State:
    mode, cause = next_mode(
        state.mode,
        Conditions(
            fault=state.fault,
            disarmed=disarmed(context, state),
            hold=clock_fault or _hold(context, state),
            goal_active=state.task.active,
        ),
    )
    if mode is Mode.DISARMED:
        state = undecided(state)
    return replace(state, mode=mode, cause=cause)


def _paused(state: State, passed_ns: int) -> State:
    """While the executive holds, its clocks stand still: waiting is no failure of an action, and confirms no doubt."""
    task, running = state.task, state.task.running
    if state.mode is not Mode.HOLDING:
        return state
    if running is None:
        until_ns = task.doubted_until_ns and task.doubted_until_ns + passed_ns
        return replace(state, task=replace(task, doubted_until_ns=until_ns))
    if state.deliberation is not None:
        state.deliberation.pause(passed_ns)
    return replace(state, task=replace(task, running=replace(running, started_ns=running.started_ns + passed_ns)))


def _with_fault(topic: str, fault: str) -> str:
    """A stale topic, and what is wrong with the messages that still arrive."""
    return f"{topic} {fault}" if fault else topic


def _stale(context: Context, state: State) -> tuple[str, ...]:
    """Required sensors that are silent."""
    return stale_topics(context.domain.required, context.domain.robot, state.arrivals, state.now_ns)


def _hold(context: Context, state: State) -> Cause | None:
    stale = _stale(context, state)
    if stale:
        faults = (state.measurements.faults.get(key_of(topic, context.domain.robot), "") for topic in stale)
        return Cause(Reason.INPUT_STALE, ", ".join(map(_with_fault, stale, faults)))
    if (age_ns := state.arming.echo_age_ns) > MAX_ROUND_TRIP_NS:
        return Cause(Reason.ROUND_TRIP, f"{age_ns / 1e6:.0f} ms, limit {MAX_ROUND_TRIP_NS / 1e6:.0f} ms")
    if not is_ready(context.domain, state.belief):
        return Cause(Reason.BELIEF_NOT_READY)
    if state.task.running is None and (slow := slow_inputs(context, state)) is not None:
        return slow
    if len(state.overruns_ns) >= context.settings.overruns_to_hold:
        return Cause(Reason.OVERRUNS, f"{len(state.overruns_ns)} in a second")
    return None
