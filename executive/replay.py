"""The replay shell: recorded inputs and granted checks through the core; no clock and no bus."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from tailor.executive.core.state import Inputs, Output, initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import Context
from tailor.executive.interfaces.budget import CheckBudget


@dataclass(frozen=True, slots=True)
class RecordedTick:
    """Inputs of one tick, and the number of checks that it was granted."""

    tick: int
    now_ns: int
    inputs: Inputs
    checks: int


def replay(context: Context, ticks: Iterable[RecordedTick]) -> Iterator[tuple[int, tuple[Output, ...]]]:
    """Run recorded ticks through the core.

    Args:
      context: The recorded run's, see composition.rebuild_context.
      ticks: All ticks of a run, from the first one.

    Yields:
      Number and outputs of each tick, as the present core computes them.
    """
    state = initial_state(context)
    for tick in ticks:
        state, outputs = step(context, state, tick.now_ns, tick.inputs, CheckBudget(tick.checks))
        yield tick.tick, outputs
