"""Growth of the executive's tick: with the length of the plan, and with the number of objects around the robot."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from functools import partial

import numpy as np

from tailor.executive import domains
from tailor.executive.composition import ExecutiveConfig, build_context
from tailor.executive.core.state import initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import Context, Settings
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.replay import RecordedTick
from tailor.simnodes.world import World
from tailor.tools.benchmarks.growth.curve import Curve
from tailor.tools.lockstep.action_run import new_body
from tailor.tools.lockstep.run import SENDER, run_lockstep

LETTERS = (1, 2, 4, 8, 12)
OPPONENTS = (1, 2, 4, 8)
SECONDS, QUICK_SECONDS = 20.0, 5.0
CHECKS = 3  # of a tick's deliberation: so few that growth is that of the rest


def curves(quick: bool) -> Iterator[Curve]:
    """CPU time of the tick that took longest, deliberation with a fixed number of checks included."""
    seconds = QUICK_SECONDS if quick else SECONDS
    plans = []
    for letters in LETTERS[:-1] if quick else LETTERS:
        scenario = "word-" + "".join(chr(65 + n % 26) for n in range(letters))
        sampled, start = domains.seeded_scenario("arm", scenario, 0)
        plans.append((float(len(sampled.places)), _longest_ms("arm", scenario, start, seconds)))
    yield Curve("longest tick against the plan", "places of the plan", "CPU time, ms", plans, 0.0)
    _, start = domains.seeded_scenario("soccer", "opponents", 0)
    crowds = [(float(n), _longest_ms("soccer", "opponents", _crowd(start, n), seconds)) for n in OPPONENTS]
    yield Curve("longest tick against opponents", "opponents on the field", "CPU time, ms", crowds, 1.0)


def _crowd(start: Mapping[str, float], count: int) -> dict[str, float]:
    """The start with so many opponents instead, in two rows across the field."""
    own = {name: value for name, value in start.items() if not name.startswith("opponent")}
    for n in range(count):
        own |= {f"opponent{n + 1}_x": 0.9 * (n // 2) - 1.5, f"opponent{n + 1}_y": 1.2 if n % 2 else -1.2}
        own[f"opponent{n + 1}_radius"] = 0.2
    return own


def _longest_ms(domain: str, scenario: str, start: Mapping[str, float], seconds: float) -> float:
    """Of the median of three replays of each tick, the longest."""
    ticks: list[RecordedTick] = []
    context, budgets = _context(domain, scenario), partial(CheckBudget, CHECKS)
    world = World(new_body(context.domain), start, 0)
    run_lockstep(context, world, limit_s=seconds, new_budget=budgets, on_tick=lambda t, _: ticks.append(t))
    replays = [_replayed_ms(_context(domain, scenario), ticks) for _ in range(3)]
    return float(np.max(np.median(replays, axis=0)))


def _replayed_ms(context: Context, ticks: list[RecordedTick]) -> list[float]:
    """CPU time of each tick, ms."""
    state, taken_ms = initial_state(context), []
    for tick in ticks:
        began = time.process_time_ns()
        state, _ = step(context, state, tick.now_ns, tick.inputs, CheckBudget(tick.checks))
        taken_ms.append((time.process_time_ns() - began) / 1e6)
    return taken_ms


def _context(domain: str, scenario: str) -> Context:
    return build_context(ExecutiveConfig(domain, scenario, Settings(seed=0)), SENDER)
