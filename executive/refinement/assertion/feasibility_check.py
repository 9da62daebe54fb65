"""Feasibility of an action: whether any value of its free parameters is predicted to succeed; sampled, resumable."""

from __future__ import annotations

import numpy as np

from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.objective.settings import RefinementSettings

SAMPLES_PER_CHECK = 256
N_STARTS = 6  # successful samples that are handed on to refinement
START_MARGIN = 0.05  # above the least failure probability


class FeasibilityCheck:
    """Samples one action of a sequence; `best_failure` is the least probability of failure so far.

    The limit is the risk accepted for the action, or else the settings' `p_fail_max`. Starts of the sequence that give
    all free parameters are judged before any sample is drawn.

    Args:
      sequence: The instantiated actions.
      position: Index of the action.
      models: Loaded models.
      settings: Limit of the failure probability, number of samples.
      rng: The only source of randomness.
    """

    def __init__(
        self,
        sequence: ActionSequence,
        position: int,
        models: Models,
        settings: RefinementSettings,
        rng: np.random.Generator,
    ) -> None:
        instance = sequence.actions[position]
        self._limit = instance.risk if instance.risk is not None else settings.p_fail_max
        arrival_ids = frozenset(sequence.actions[position - 1].variables) if position else frozenset()
        actions = sequence.actions[position : position + 1]
        self.best_failure = 1.0
        self._best: list[tuple[float, dict[int, float]]] = []  # failure and values by variable id, least failure first
        self._objective = SequenceObjective(actions, sequence.variables, models, settings, arrival_ids)
        complete = [start for start in sequence.starts if start.keys() >= set(self._objective.ids)]
        self._known = self._objective.vectors(complete if self._objective.ids else ())  # not yet evaluated here
        self._rng = rng
        self._remaining = settings.assertion_samples if self._objective.ids else 1

    @property
    def starts(self) -> list[dict[int, float]]:
        """Values by variable id of the best samples so far, within START_MARGIN of the best; least failure first."""
        return [values for failure, values in self._best if failure <= self.best_failure + START_MARGIN]

    def advance(self, budget: Budget) -> bool | None:
        """True: some sample keeps the failure within the limit. False: none does. None: the budget is spent."""
        while self.best_failure > self._limit:
            if self._remaining <= 0 and not len(self._known):
                return False
            if budget.spent():
                return None
            if len(self._known):
                self._take_known()
            else:
                self._draw(min(SAMPLES_PER_CHECK, self._remaining))
        return True

    def _take_known(self) -> None:
        """Keep all candidates of an earlier search that are within the limit: they are good for more than that."""
        failures = self._failures(self._known)
        within = failures <= self._limit
        self._keep(self._known[within], failures[within], len(failures))
        self._known = self._known[:0]

    def _draw(self, count: int) -> None:
        samples = self._objective.ranges.draw(count, self._rng)
        self._keep(samples, self._failures(samples), N_STARTS)
        self._remaining -= count

    def _keep(self, samples: Array, failures: Array, count: int) -> None:
        """Keep the best `count` of samples, shape (n, d), and of those kept before."""
        order = np.argsort(failures, kind="stable")[:count]
        kept = [(float(failures[i]), self._objective.values(samples[i])) for i in order]
        self._best = sorted((*self._best, *kept), key=lambda each: each[0])[:count]
        self.best_failure = min(self.best_failure, float(failures.min(initial=1.0)))

    def _failures(self, samples: Array) -> Array:
        """Probability of failure at the worst arrival, shape (n,); 1 where a prediction is not finite."""
        prediction = self._objective.stages[0].predict(samples)
        finite = np.isfinite(prediction.worst_failure + prediction.duration_s)
        failures: Array = np.where(finite, prediction.worst_failure, 1.0)
        return failures
