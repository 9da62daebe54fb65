"""A sweep over the free angle of approach at one start: what was predicted at its outset and how long it took."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.values import Array
from tailor.tools.evaluations.outcome import Outcome


@dataclass(frozen=True, slots=True)
class Sweep:
    """n angles. Rows of the tables: approach with its asserted subgoals, everything after it, the sum; NaN: failed."""

    seed: int
    angles: Array  # (n,) rad, ascending from -pi, equally spaced round the circle
    v: float  # m/s at the ball, the same for all
    predicted_s: Array  # (3, n) when the episode began
    simulated_s: Array  # (3, n) mean of the repeats
    least_s: Array  # (3, n) of the repeats
    most_s: Array  # (3, n)
    asserted: NDArray[np.bool_]  # (n,) whether the executive asserted a subgoal there
    greedy_rad: float  # what greedy chooses at this start, and what refinement chooses
    refined_rad: float

    @property
    def model_best(self) -> int:
        """Place of the angle with the least predicted sum, of those that can be judged."""
        return int(np.nanargmin(np.where(np.isfinite(self.simulated_s[2]), self.predicted_s[2], np.nan)))

    @property
    def simulated_best(self) -> int:
        """Place of the angle with the least simulated sum."""
        return int(np.nanargmin(self.simulated_s[2]))

    @property
    def bias_s(self) -> list[float]:
        """Mean of predicted minus simulated over the angles: approach, what comes after it, sum."""
        means: list[float] = np.nanmean(self.predicted_s - self.simulated_s, axis=1).tolist()
        return means

    @property
    def correlation(self) -> float:
        """Of predicted and simulated sums over the angles."""
        both = np.isfinite(self.predicted_s[2]) & np.isfinite(self.simulated_s[2])
        return float(np.corrcoef(self.predicted_s[2, both], self.simulated_s[2, both])[0, 1])

    def simulated_at(self, angle: float) -> float:
        """The simulated sum at any angle, between its neighbours."""
        known = np.isfinite(self.simulated_s[2])
        return float(np.interp(angle, self.angles[known], self.simulated_s[2, known], period=2 * np.pi))


def sweep_of(
    seed: int, angles: Array, v: float, runs: Sequence[Sequence[Outcome]], greedy_rad: float, refined_rad: float
) -> Sweep | None:
    """Put the runs at every angle together; None if none reached the goal."""
    predicted = np.array([np.mean([_foreseen_s(run) for run in some], axis=0) for some in runs]).T
    took = np.array([[_took_s(run) for run in some] for some in runs]).transpose(2, 0, 1)  # (3, n, repeats)
    if not np.isfinite(took).any():
        return None
    missing = ~np.isfinite(took).any(axis=2)
    filled = np.where(missing[:, :, None], np.inf, took)  # so that no slice is all NaN
    mean, least, most = (of(filled, axis=2) for of in (np.nanmean, np.nanmin, np.nanmax))
    mean, least, most = (np.where(missing, np.nan, table) for table in (mean, least, most))
    asserted = np.array([any(predicted_actions[1] for predicted_actions in some[0].predicted_actions) for some in runs])
    return Sweep(seed, angles, v, predicted, mean, least, most, asserted, greedy_rad, refined_rad)


def _foreseen_s(run: Outcome) -> tuple[float, float, float]:
    """Predicted at the outset: approach with asserted subgoals, what comes after, sum."""
    names = [name for name, _, _ in run.predicted_actions]
    if "approachBall" not in names:
        return float("nan"), float("nan"), float("nan")
    seconds = [s for _, _, s in run.predicted_actions]
    end = names.index("approachBall") + 1
    return sum(seconds[:end]), sum(seconds[end:]), sum(seconds)


def _took_s(run: Outcome) -> tuple[float, float, float]:
    """The same as it came. The approach ends when one is done, however often it was tried; the sum is the episode."""
    ends = list(zip(run.actions, run.outcomes, strict=True))
    if not run.achieved or ("approachBall", "done") not in ends:
        return float("nan"), float("nan"), float("nan")
    approach_s = sum(run.actual_s[: ends.index(("approachBall", "done")) + 1])
    return approach_s, run.duration_s - approach_s, run.duration_s
