"""Cost of an asserted subgoal at every place on the ground (paper, Figure 15).

Each place has its best heading and speed; a place without any that is predicted to succeed is INVALID.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from tailor.executive.deliberation.context import Context
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.schemas.messages import Contexts, Subgoals
from tailor.tools.viewer.explanations.decided_sequence import chosen_values, sequence_of

STEP_M = 0.1
MARGIN_M = 1.2  # around start, goal and subgoal
HEADINGS, SPEEDS = 20, 4  # sampled at each place, besides the chosen ones
ROWS_AT_ONCE = 20_000


@dataclass(frozen=True, slots=True)
class SubgoalMap:
    """Values at every place, shape (len(y), len(x)); seconds are NaN where the subgoal is INVALID."""

    x: Array  # m
    y: Array
    first_s: Array  # to the subgoal
    second_s: Array  # from there to the goal
    success: Array  # of the less sure of both actions, wherever they may arrive, by the best heading and speed there
    limit: float  # of failure, that the executive kept
    subgoal: tuple[float, float, float]  # as chosen: x, y, heading
    start: tuple[float, float]
    goal: tuple[float, float, float]  # place and heading where the second action leads
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


@dataclass(frozen=True, slots=True)
class _Decision:
    """A subgoal action and the action after it, with the subgoal chosen between them."""

    sequence: ActionSequence
    objective: SequenceObjective
    chosen: Array  # (d,) free vector
    limit: float

    def place_of(self, quantity: str) -> int:
        """Place of the subgoal's quantity in the free vector."""
        variables = self.sequence.variables
        return next(k for k, i in enumerate(self.objective.ids) if variables[i].quantity == quantity)

    def pose(self, action: int, first: int) -> tuple[float, float, float]:
        """x, y and heading in an action's parameters from `first` on: 0 where it starts, 4 where it leads."""
        values = self.objective.values(self.chosen)
        variables = (self.sequence.variables[i] for i in self.sequence.actions[action].variables[first : first + 3])
        x, y, phi = (values.get(v.id, 0.0) if v.value is None else v.value for v in variables)
        return x, y, phi


def subgoal_map_of(message: Subgoals, context: Context, objects: Contexts | None = None) -> SubgoalMap | None:
    """The ground for a decision among objects; None unless it asserts one subgoal before its next action."""
    decision = _decision(message, context, objects)
    if decision is None:
        return None
    start, subgoal, goal = decision.pose(0, 0), decision.pose(0, 4), decision.pose(1, 4)
    corners = np.array([start[:2], subgoal[:2], goal[:2]])
    low, high = corners.min(axis=0) - MARGIN_M, corners.max(axis=0) + MARGIN_M
    x, y = (np.arange(low[k], high[k], STEP_M) for k in (0, 1))
    places = np.array(list(product(x, y)))
    parts = -(-len(places) * (HEADINGS + 1) * (SPEEDS + 1) // ROWS_AT_ONCE)
    tables = [_best(decision, part) for part in np.array_split(places, parts)]
    first_s, second_s, success = (
        np.concatenate(column).reshape(len(x), len(y)).T for column in zip(*tables, strict=True)
    )
    chosen_s = _durations_s(decision)
    return SubgoalMap(x, y, first_s, second_s, success, decision.limit, subgoal, start[:2], goal, chosen_s)


def _decision(message: Subgoals, context: Context, objects: Contexts | None) -> _Decision | None:
    sequence = sequence_of(message, context.domain.actions, objects)
    if sequence is None or [action.asserted for action in sequence.actions[:2]] != [True, False]:
        return None
    settings = context.settings.refinement
    objective = SequenceObjective(sequence.actions[:2], sequence.variables, context.models, settings)
    chosen = objective.vector(chosen_values(message))
    worst = max(float(prediction.worst_failure[0]) for prediction in objective.predict(chosen[None]))
    # Where no subgoal kept the limit, the least risk was settled for.
    return _Decision(sequence, objective, chosen, max(settings.p_fail_max, worst + 1e-9))


def _durations_s(decision: _Decision) -> tuple[float, float]:
    """Predicted for the subgoal as chosen: to it, and from it."""
    first, second = (float(prediction.duration_s[0]) for prediction in decision.objective.predict(decision.chosen))
    return first, second


def _best(decision: _Decision, places: Array) -> tuple[Array, Array, Array]:
    """Both durations and the success at some places, each of shape (n,), by the best heading and speed."""
    candidates, objective = _candidates(decision, places), decision.objective
    first, second = (stage.predict(candidates[:, stage.columns]) for stage in objective.stages)
    failure = np.maximum(first.worst_failure, second.worst_failure).reshape(len(places), -1)
    first_s, second_s = (prediction.duration_s.reshape(len(places), -1) for prediction in (first, second))
    total = np.where(failure <= decision.limit, first_s + second_s, np.inf)
    rows, best = np.arange(len(places)), total.argmin(axis=1)
    valid = np.isfinite(total[rows, best])
    picked = [np.where(valid, seconds[rows, best], np.nan) for seconds in (first_s, second_s)]
    return picked[0], picked[1], 1 - failure.min(axis=1)


def _candidates(decision: _Decision, places: Array) -> Array:
    """Every place with every heading and speed, those that were chosen among them, shape (n * ways, d)."""
    x, y, phi, v = (decision.place_of(quantity) for quantity in ("x", "y", "phi", "v"))
    chosen, ranges = decision.chosen, decision.objective.ranges
    headings = np.append(np.linspace(-np.pi, np.pi, HEADINGS, endpoint=False), chosen[phi])
    speeds = np.append(np.linspace(ranges.lower[v], ranges.upper[v], SPEEDS), chosen[v])
    ways = np.array(list(product(headings, speeds)))
    candidates = np.tile(chosen, (len(places) * len(ways), 1))
    candidates[:, [x, y]] = np.repeat(places, len(ways), axis=0)
    candidates[:, [phi, v]] = np.tile(ways, (len(places), 1))
    return candidates
