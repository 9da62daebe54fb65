"""Choice for the actions after the running one, searched while it runs: the next deliberation begins with it.

Where a decision takes several ticks, its action begins with what the first of them found. The search for what comes
next has the time of a whole action.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from tailor.executive.deliberation.context import Context
from tailor.executive.deliberation.deliberation import Decision
from tailor.executive.interfaces.budget import Budget
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.refinement import Refinement


class NextChoice:
    """Refinement of a decision's actions after the first, from the subgoal that the first leads to.

    Their asserted subgoals are those of the decision. Changed in place, owned by one state.

    Args:
      context: Models and settings.
      decision: Its first action runs.
    """

    def __init__(self, context: Context, decision: Decision) -> None:
        self.decision = decision
        self._sequence = _after_first(decision)
        self._refinement: Refinement | None = None
        if self._sequence.actions:
            settings = context.settings
            rng = np.random.default_rng([settings.seed, 5, decision.number])
            self._refinement = Refinement(
                self._sequence, context.models, settings.refinement, rng, start=decision.choice.values
            )

    def advance(self, budget: Budget) -> None:
        """Continue until the search has ended or the budget is spent."""
        if self._refinement is not None and not self._refinement.finished:
            self._refinement.advance(budget)

    def values(self) -> Mapping[tuple[str, str], float]:
        """The best values so far by label and quantity; empty if there are none."""
        choice = self._refinement.choice if self._refinement is not None else None
        if choice is None or not choice.valid:
            return {}
        variables = self._sequence.variables
        return {(variables[i].label, variables[i].quantity): value for i, value in choice.values.items()}


def _after_first(decision: Decision) -> ActionSequence:
    first, *rest = decision.sequence.actions
    chosen = decision.choice.values
    reached = {i: chosen[i] for i in first.variables if i in chosen}
    return replace(decision.sequence.bind(reached), actions=tuple(rest), starts=())
