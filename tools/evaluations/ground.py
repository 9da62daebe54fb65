"""The search space of an asserted subgoal over the ground (paper, Figure 15): what it costs to have it at every place.

At each place the heading and the speed are the best that there are; where none is predicted to succeed it is INVALID.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from executive.core.context import Context
from executive.refinement.objective import SequenceObjective
from executive.refinement.sequence import ActionSequence
from schemas.messages import Subgoals
from tools.viewer.explanation import chosen_values, sequence_of

Array = NDArray[np.float64]

STEP_M = 0.1
MARGIN_M = 1.2  # around start, goal and subgoal
HEADINGS, SPEEDS = 20, 4  # tried at each place, beside those that were chosen
ROWS_AT_ONCE = 20_000


@dataclass(frozen=True, slots=True)
class Ground:
    """Values at every place, shape (len(y), len(x)); seconds are NaN where the subgoal is INVALID."""

    x: Array  # m
    y: Array
    first_s: Array  # to the subgoal
    second_s: Array  # from there to the goal
    success: Array  # of the second action, wherever it may arrive, by the best heading and speed there
    limit: float  # of its failure, that the executive kept
    subgoal: tuple[float, float, float]  # as chosen: x, y, heading
    start: tuple[float, float]
    goal: tuple[float, float, float]  # place and heading of the ball's approach
    chosen_s: tuple[float, float]  # predicted for the subgoal as chosen

    @property
    def total_s(self) -> Array:
        """The sum, which refinement minimises (without its terms for spread and risk)."""
        return self.first_s + self.second_s

    @property
    def least_s(self) -> float:
        """The least sum that was looked at."""
        return min(float(np.nanmin(self.total_s, initial=np.inf)), sum(self.chosen_s))

    @property
    def valid_pct(self) -> float:
        """Share of the places that are valid."""
        return 100 * float(np.mean(np.isfinite(self.total_s)))


def ground_of(message: Subgoals, context: Context) -> Ground | None:
    """The ground for the first decision of an episode; None unless it puts one detour before its next action."""
    sequence = sequence_of(message, context.domain.actions)
    if sequence is None or [action.asserted for action in sequence.actions[:2]] != [True, False]:
        return None
    settings = context.settings.refinement
    objective = SequenceObjective(sequence.actions[:2], sequence.variables, context.models, settings)
    chosen = objective.vector(chosen_values(message))
    first, second = objective.stages
    worst = float(second.predict(chosen[None, second.columns]).worst_failure[0])
    limit = max(settings.p_fail_max, worst + 1e-9)  # where no subgoal kept the limit, the least was settled for
    quantities = {sequence.variables[i].quantity: place for place, i in enumerate(objective.ids)}
    named = {quantity: (low, high) for quantity, low, high in _corners(sequence, chosen, quantities)}
    x, y = (np.arange(low, high, STEP_M) for low, high in (named["x"], named["y"]))
    places = np.array(list(product(y, x)))
    tables = [_best(objective, chosen, quantities, part, limit) for part in np.array_split(places, _parts(len(places)))]
    first_s, second_s, success = (np.concatenate(parts).reshape(len(y), len(x)) for parts in zip(*tables, strict=True))
    at, to = (_told(sequence, chosen, objective, k) for k in (0, 4))
    goal = _told(_through(sequence), chosen, objective, 4)
    took = [float(stage.predict(chosen[None, stage.columns]).duration_s[0]) for stage in (first, second)]
    return Ground(x, y, first_s, second_s, success, limit, to, at[:2], goal, (took[0], took[1]))


def _through(sequence: ActionSequence) -> ActionSequence:
    """The sequence from its second action on."""
    return ActionSequence(sequence.actions[1:], sequence.variables, sequence.library)


def _told(
    sequence: ActionSequence, chosen: Array, objective: SequenceObjective, first: int
) -> tuple[float, float, float]:
    """x, y and heading of the place that begins at a parameter of the first action."""
    values = objective.values(chosen)
    ids = sequence.actions[0].variables[first : first + 3]
    told = [values.get(i, sequence.variables[i].value) for i in ids]
    x, y, phi = (0.0 if value is None else float(value) for value in told)
    return x, y, phi


def _corners(sequence: ActionSequence, chosen: Array, quantities: dict[str, int]) -> list[tuple[str, float, float]]:
    """The stretch of ground to look at: around start, subgoal and goal, within the subgoal's ranges."""
    corners = []
    for offset, quantity in enumerate(("x", "y")):
        start, goal = (
            sequence.variables[action.variables[place + offset]].value
            for action, place in zip(sequence.actions[:2], (0, 4), strict=True)
        )
        seen = [value for value in (start, goal, float(chosen[quantities[quantity]])) if value is not None]
        corners.append((quantity, min(seen) - MARGIN_M, max(seen) + MARGIN_M))
    return corners


def _parts(places: int) -> int:
    return -(-places * (HEADINGS + 1) * (SPEEDS + 1) // ROWS_AT_ONCE)


def _best(
    objective: SequenceObjective, chosen: Array, quantities: dict[str, int], places: Array, limit: float
) -> tuple[Array, Array, Array]:
    """Both durations and the success at some places, each of shape (n,), by the best heading and speed."""
    phi, v = quantities["phi"], quantities["v"]
    headings = np.append(np.linspace(-np.pi, np.pi, HEADINGS, endpoint=False), chosen[phi])
    speeds = np.append(np.linspace(objective.ranges.lower[v], objective.ranges.upper[v], SPEEDS), chosen[v])
    ways = list(product(headings, speeds))
    candidates = np.tile(chosen, (len(places) * len(ways), 1))
    for quantity, column in (("y", 0), ("x", 1)):
        candidates[:, quantities[quantity]] = np.repeat(places[:, column], len(ways))
    for quantity, column in (("phi", 0), ("v", 1)):
        candidates[:, quantities[quantity]] = np.tile(np.array(ways)[:, column], len(places))
    first, second = (stage.predict(candidates[:, stage.columns]) for stage in objective.stages)
    failure = second.worst_failure.reshape(len(places), -1)
    first_s, second_s = (said.duration_s.reshape(len(places), -1) for said in (first, second))
    total = np.where(failure <= limit, first_s + second_s, np.inf)
    rows, best = np.arange(len(places)), total.argmin(axis=1)
    valid = np.isfinite(total[rows, best])
    picked = [np.where(valid, seconds[rows, best], np.nan) for seconds in (first_s, second_s)]
    return picked[0], picked[1], 1 - failure.min(axis=1)
