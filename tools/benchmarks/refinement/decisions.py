"""Sequences that the executive refines first in a scenario, with every free parameter of the whole plan."""

from __future__ import annotations

from functools import partial

from tailor.executive import domains
from tailor.executive.composition import ExecutiveConfig, build_context
from tailor.executive.core.state import initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import Context, Settings
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.replay import RecordedTick
from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.benchmarks.refinement.cases import Case
from tailor.tools.lockstep.run import CHECKS_PER_TICK, SENDER, run_lockstep
from tailor.tools.lockstep.worlds import make_world

DECISION_S = 2.0  # by then a plan is found and its parameters are chosen


def first_decision(domain: str, scenario: str, seed: int) -> tuple[Models, Case]:
    """The models of a domain's robot, and the sequence of the first decision from one start.

    Raises:
      NoMeasurement: Nothing is decided within DECISION_S.
    """
    ticks: list[RecordedTick] = []
    context = _context(domain, scenario, seed)
    world = make_world(domains.load(domain).robot, scenario, seed)
    budgets = partial(CheckBudget, CHECKS_PER_TICK)
    run_lockstep(context, world, limit_s=DECISION_S, new_budget=budgets, on_tick=lambda tick, _: ticks.append(tick))
    sequence = _decided(_context(domain, scenario, seed), ticks)
    if sequence is None:
        raise NoMeasurement(f"{domain} {scenario}, seed {seed}: nothing is decided within {DECISION_S:g} s")
    return context.models, Case(scenario, sequence.actions, sequence.variables, sequence.starts)


def _decided(context: Context, ticks: list[RecordedTick]) -> ActionSequence | None:
    """The sequence of the first decision in a replay of the ticks; None without one."""
    state = initial_state(context)
    for tick in ticks:
        state, _ = step(context, state, tick.now_ns, tick.inputs, CheckBudget(tick.checks))
        if state.task.decision is not None:
            return state.task.decision.sequence
    return None


def _context(domain: str, scenario: str, seed: int) -> Context:
    return build_context(ExecutiveConfig(domain, scenario, Settings(seed=seed)), SENDER)
