"""A run under a budget that nobody can predict is repeated exactly from its inputs and the checks that were granted."""

from __future__ import annotations

import dataclasses

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.executive.core.state import initial_state
from tailor.executive.core.step import step
from tailor.executive.replay import RecordedTick, replay
from tests.support.toy_domain import inputs, line_context

TICK = 100_000_000
GOAL = "(and (visited a) (visited b) (at b))"


class FickleBudget:
    """Ends at random, like a clock on a busy machine."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.granted = 0
        self._rng = rng
        self._over = False

    def spent(self) -> bool:
        self._over = self._over or self._rng.random() < 0.2
        self.granted += not self._over
        return self._over


def recorded_run(seed: int, ticks: int):
    context, rng = line_context(), np.random.default_rng(seed)
    state, x = initial_state(context), 0.0
    tape, outputs = [], []
    for n in range(1, ticks):
        given_inputs = inputs(n * TICK, x + 0.01 * rng.standard_normal(), GOAL if n == 1 else "")
        budget = FickleBudget(rng)
        state, published = step(context, state, n * TICK, given_inputs, budget)
        tape.append(RecordedTick(n, n * TICK, given_inputs, budget.granted))
        outputs.append((n, published))
        x += 0.1 * state.command[0]
    return tape, outputs


@settings(max_examples=10, deadline=None)
@given(seed=st.integers(0, 10_000))
def test_replay_gives_the_recorded_outputs_bit_for_bit(seed):
    tape, outputs = recorded_run(seed, ticks=60)
    assert list(replay(line_context(), tape)) == outputs


def test_replay_with_other_checks_is_noticed():
    tape, outputs = recorded_run(3, ticks=30)
    changed = [dataclasses.replace(t, checks=t.checks + 5) for t in tape]
    assert list(replay(line_context(), changed)) != outputs
