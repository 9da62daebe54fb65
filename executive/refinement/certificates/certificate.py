"""Certificate of a choice: a lower bound on the optimum of the models, and the gap to it."""

from __future__ import annotations

from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.certificates.proof import Proof
from tailor.executive.refinement.certificates.stage_bounds import NoBound, stage_bound
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.chain_structure import blocks_of, links_of


class Certificate:
    """Proves that no choice costs less than `bound`; anytime and resumable.

    It holds its proof and the proof's steps, which do not hold it: an abandoned one is freed without a collection.
    """

    def __init__(self, proof: Proof, settings: RefinementSettings) -> None:
        """Nothing is proven before `advance`."""
        self.checks = 0
        self.finished = False
        self._proof = proof
        self._given_value = proof.value
        self._steps = proof.steps()
        self._most_checks = settings.certify_checks

    @property
    def bound(self) -> float:
        """Seconds; no choice costs less."""
        return self._proof.bound

    @property
    def best(self) -> Array:
        """The given choice, shape (d,), or a better one that the proof has found."""
        return self._proof.best

    @property
    def value(self) -> float:
        """Seconds that `best` costs."""
        return self._proof.value

    @property
    def gap_pct(self) -> float | None:
        """Upper bound on the gap between the given choice and the optimum, in percent; None without a proof."""
        return 100 * (self._given_value / self.bound - 1) if 0 < self.bound <= self.value < float("inf") else None

    def advance(self, budget: Budget) -> None:
        """Resume the proof until the budget is spent or no more can be proven."""
        while not self.finished and not budget.spent():
            self.checks += 1
            done = next(self._steps, True)
            self.finished = done is not None or self.checks >= self._most_checks


def certificate(objective: SequenceObjective, best: Array, settings: RefinementSettings) -> Certificate | NoBound:
    """Certificate of a choice, shape (d,), or the reason why there is none."""
    blocks = blocks_of(objective.stages)
    if blocks is None:
        return NoBound("a parameter occurs in actions that are not neighbours")
    bounds = []
    for stage, link in zip(objective.stages, links_of(objective.stages, blocks), strict=True):
        bound = stage_bound(stage, link, settings)
        if isinstance(bound, NoBound):
            return bound
        bounds.append(bound)
    return Certificate(Proof(objective, blocks, bounds, best, settings), settings)
