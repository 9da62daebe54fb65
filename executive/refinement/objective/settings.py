"""Settings of assertion and refinement, with the reasons for their defaults."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from tailor.schemas.errors import UsageError

COUNTS = ("horizon", "batch", "patience", "checks_max", "greedy_checks", "assertion_samples", "weighing_checks")
NOT_NEGATIVE = (
    "k_std", "risk_cost_s", "gain_min_s", "worth_s", "energy_weight", "assertion_depth", "certify_checks",
    "certify_gap_pct",
)  # fmt: skip
MAX_ROWS = 1_000_000  # asked of a model at once, of each parameter: more do not fit into memory
# Of 150 arrivals of AGILO's goToPose: 5 cm and 3 degrees; quantities of other robots are not among these
ARRIVAL_SPREAD = (("x", 0.05), ("y", 0.05), ("phi", 0.05), ("v", 0.05))
SolverName = Literal["auto", "chain", "genetic", "differential"]


@dataclass(frozen=True, slots=True)
class RefinementSettings:
    """How subgoals are asserted and refined.

    `arrival_spread` gives, by quantity, the standard deviation of where the robot really is when it has arrived at a
    subgoal (learned from episodes); empty: it arrives exactly. `risk_cost_s` is what a failed action costs: the
    objective grows by it times the predicted probability of failure.
    """

    horizon: int = 2  # actions looked ahead; more than two pays little (paper Table 4)
    solver: SolverName = "auto"
    k_std: float = 1.0  # durations count as mean + k standard deviations: guards against the optimiser's curse
    p_fail_max: float = 0.05  # above it an action after a detour is INVALID (Algorithm 4), wherever it may arrive
    p_fail_assert: float = 0.06  # above it an action is predicted to fail and gets a detour; a little wider, so that a
    # robot that has arrived beside its subgoal is not sent around again; 0.2 bumped more on training seeds
    p_fail_settle: float = 0.5  # where no start keeps p_fail_max, the least that is found is accepted up to this
    risk_cost_s: float = 6.0  # seconds that a failure costs; on training seeds 3 bumps more balls and 10 gains less
    gain_min_s: float = 0.0  # a smaller predicted gain is not worth leaving the greedy choice for
    gate: bool = True  # keep the greedy choice where the robot's benefit tree says so (paper 6.3.2)
    arrival_spread: tuple[tuple[str, float], ...] = ARRIVAL_SPREAD
    energy_weight: float = 0.0  # seconds that a joule is worth (paper 8); needs "<action>/energy" models
    batch: int = 256  # rows that one check of the chain solver asks of a model, about 0.1 ms with ten bagged trees
    patience: int = 25  # checks without an improvement that is worth it until the search ends
    worth_s: float = 0.002  # such an improvement
    checks_max: int = 500  # the paper's 500 generations
    greedy_checks: int = 6  # batches spent on the first, greedy answer
    assertion_depth: int = 2  # detours in a row before one action
    assertion_samples: int = 1024  # values of the free parameters that must all fail before a detour is made
    compare_subgoals: bool = True  # a detour must pay: compare expected costs, failure priced at risk_cost_s
    weighing_checks: int = 40  # batches spent on each side of that comparison
    certify_checks: int = 100  # of about 1 ms, spent on proving how good a choice is when it is found; 0: none
    certify_gap_pct: float = 1.0  # above the optimum: near enough to stop

    def __post_init__(self) -> None:
        for name in COUNTS:
            if getattr(self, name) < 1:
                raise UsageError(f"refinement.{name} is {getattr(self, name)}, expected at least 1")
        for name in ("batch", "assertion_samples"):
            if getattr(self, name) > MAX_ROWS:
                raise UsageError(f"refinement.{name} is {getattr(self, name)}, expected at most {MAX_ROWS}")
        for quantity, deviation in self.arrival_spread:
            if not (math.isfinite(deviation) and deviation >= 0):
                raise UsageError(
                    f"refinement.arrival_spread of {quantity} is {deviation}, expected a finite number >= 0"
                )
        for name in NOT_NEGATIVE:
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0):
                raise UsageError(f"refinement.{name} is {value}, expected a finite number >= 0")
        for name in ("p_fail_max", "p_fail_assert", "p_fail_settle"):
            if not 0 <= getattr(self, name) <= 1:
                raise UsageError(f"refinement.{name} is {getattr(self, name)}, expected a probability")
