"""Settings of assertion and refinement, with the reasons for their defaults."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from tailor.schemas.errors import UsageError

COUNTS = (
    "horizon", "patience", "checks_max", "greedy_checks", "assertion_depth", "assertion_samples", "comparison_checks",
)  # fmt: skip
NOT_NEGATIVE = (
    "k_std", "risk_cost_s", "gain_min_s", "gain_k_std", "worth_s", "energy_weight", "certify_checks",
    "certify_gap_pct",
)  # fmt: skip
PROBABILITIES = ("p_fail_max", "p_fail_assert", "p_fail_settle")
MIN_BATCH = 8  # candidates of a few kinds, at least one of each
MAX_ROWS = 1_000_000  # model inputs in one call, for each parameter: more exceed the memory
# One check does all of these, and ticks wait for it: 35 ms with 8 subgoals, 109 ms for the greedy answer of 50 actions
AT_MOST = {
    "batch": MAX_ROWS, "assertion_samples": MAX_ROWS, "assertion_depth": 8, "horizon": 50, "greedy_checks": 100,
}  # fmt: skip
MAX_NUMBER = 1e6  # of times, weights and spreads: sums of larger ones overflow
# From 150 arrivals of AGILO's goToPose: 5 cm and 3 degrees; other robots have no parameters of these quantities
ARRIVAL_SPREAD = (("x", 0.05), ("y", 0.05), ("phi", 0.05), ("v", 0.05))
SolverName = Literal["auto", "chain", "genetic", "differential"]


@dataclass(frozen=True, slots=True)
class RefinementSettings:
    """Settings of subgoal assertion and refinement, table `[executive.refinement]` of a deployment.

    `arrival_spread` is the standard deviation of the robot's arrival at a subgoal by quantity, learned from episodes;
    empty: exact arrival. `risk_cost_s` is the price of a failed action: the objective adds it times the predicted
    probability of failure.
    """

    horizon: int = 2  # actions optimised together; more than two gain little (paper Table 4)
    solver: SolverName = "auto"
    k_std: float = 1.0  # durations count as mean + k standard deviations: guards against the optimiser's curse
    p_fail_max: float = 0.05  # above it an action after an asserted subgoal is INVALID (Algorithm 4), at any arrival
    p_fail_assert: float = 0.06  # above it an action is predicted to fail and gets an asserted subgoal; above
    # p_fail_max, so that an arrival beside the subgoal asserts no second one; 0.2 hit more balls on training seeds
    p_fail_settle: float = 0.5  # if no start keeps p_fail_max, the least risk is accepted up to this
    risk_cost_s: float = 6.0  # seconds that a failure costs; on training seeds 3 hits more balls and 10 gains less
    gain_min_s: float = 0.0  # the greedy choice is kept for a smaller predicted gain
    gain_k_std: float = 0.5  # and for one of so many standard deviations of the difference: when it was chosen
    # 5.0 % of 400 training starts were slower at 0, 2.8 % at 0.5, 1.5 % at 1; the gain was 12.95, 12.5 and 12.0 %
    arrival_spread: tuple[tuple[str, float], ...] = ARRIVAL_SPREAD
    energy_weight: float = 0.0  # seconds for a joule (paper 8); needs "<action>/energy" models
    batch: int = 256  # model inputs in one check of the chain solver, about 0.1 ms with ten bagged trees
    patience: int = 25  # checks without an improvement of worth_s until the search ends
    worth_s: float = 0.002
    checks_max: int = 500  # the paper's 500 generations
    greedy_checks: int = 6  # batches for the first, greedy answer
    assertion_depth: int = 2  # asserted subgoals in a row before one action
    assertion_samples: int = 1024  # values of the free parameters that must all fail before a subgoal is asserted
    compare_subgoals: bool = True  # assert only at a lower expected cost, with a failure priced at risk_cost_s
    comparison_checks: int = 40  # batches for each side of that comparison
    certify_checks: int = 100  # of 1 to 8 ms, for the proof of the optimality gap of the final choice; 0: no proof
    certify_gap_pct: float = 1.0  # optimality gap at which the proof stops

    def __post_init__(self) -> None:
        for name in COUNTS:
            self._require(name, getattr(self, name) >= 1, "at least 1")
        self._require("batch", self.batch >= MIN_BATCH, f"at least {MIN_BATCH}")
        for name, most in AT_MOST.items():
            self._require(name, getattr(self, name) <= most, f"at most {most}")
        expected = f"a number from 0 to {MAX_NUMBER:g}"
        for quantity, deviation in self.arrival_spread:
            if not 0 <= deviation <= MAX_NUMBER:
                raise UsageError(f"refinement.arrival_spread of {quantity} is {deviation}, expected {expected}")
        for name in NOT_NEGATIVE:
            self._require(name, 0 <= getattr(self, name) <= MAX_NUMBER, expected)
        for name in PROBABILITIES:
            self._require(name, 0 <= getattr(self, name) <= 1, "a probability")

    def _require(self, name: str, valid: bool, expected: str) -> None:
        """Raise UsageError if a setting is not valid."""
        if not valid:
            raise UsageError(f"refinement.{name} is {getattr(self, name)}, expected {expected}")
