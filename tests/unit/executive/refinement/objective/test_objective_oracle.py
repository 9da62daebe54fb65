"""The objective against a slow evaluation in plain Python: one candidate, one arrival and one object after another."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.assertion.asserted_subgoal import with_subgoal
from tailor.executive.refinement.objective.arrivals import displacements
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence, InstantiatedAction
from tailor.executive.refinement.objective.settings import RefinementSettings
from tests.support.synthetic_models import PI, PoseDuration
from tests.unit.executive.refinement.synthetic_context import APPROACH_AROUND, BESIDE, CONTEXT, DRIBBLE, GO_AROUND
from tests.unit.executive.refinement.synthetic_context import beside as beside_objects

PRICED = replace(CONTEXT, failure_cost_s=20.0, may_meet=lambda arguments, rows: arguments[:, 4] < rows[:, :1] + 1.5)
NEAR_BALL = replace(
    APPROACH_AROUND,
    context=PRICED,
    subgoal_risk=lambda subgoals, action: np.exp(-np.hypot(subgoals[:, 4] - action[4], subgoals[:, 5] - action[5])),
)


class Joules(PoseDuration):
    def predict(self, arguments: Array) -> tuple[Array, Array]:
        mean, std = super().predict(arguments)
        return 3 * mean**2, std


LOADED = Models(
    {
        **BESIDE.durations,
        "goToPose/duration_beside": PoseDuration(1.5),
        "goToPose/energy": Joules(),
        "dribbleBall/energy": Joules(2.0),
    },
    BESIDE.successes,
)


@dataclass
class Outcome:
    """What an arrival is predicted to lead to."""

    duration_s: float
    std_s: float
    own: float  # probabilities of success
    in_spite: float
    joule: float
    risk: float


def arrivals(instance: InstantiatedAction, exact: list[float], before: set[int], chosen: RefinementSettings):
    """Parameters of each displaced arrival."""
    parameters = instance.action.parameters
    shared = [j for j, i in enumerate(instance.variables) if i in before]
    for point in displacements([parameters[j].quantity for j in shared], dict(chosen.arrival_spread)):
        moved = list(exact)
        for j, off in zip(shared, point, strict=True):
            lower, upper = min(exact[j], parameters[j].lower), max(exact[j], parameters[j].upper)
            moved[j] = exact[j] + off if parameters[j].periodic else min(max(exact[j] + off, lower), upper)
        yield moved


def outcome(instance: InstantiatedAction, row: list[float], following: list[float] | None) -> Outcome:
    action, arguments = instance.action, np.array([row])
    path = action.duration_model + "_beside" * (bool(instance.context) and action.duration_model.startswith("goTo"))
    (mean,), (std,) = LOADED.durations[path].predict(arguments)
    own = LOADED.successes[action.success_model].probability(arguments)[0] if action.success_model else 1.0
    in_spite = 1.0
    for thing in instance.context:
        if action.context.may_meet is None or action.context.may_meet(arguments, np.array([thing]))[0, 0]:
            in_spite *= LOADED.successes["goToPose/clearance"].probability(np.array([[*row, *thing]]))[0]
    joule = LOADED.durations[action.duration_model.replace("duration", "energy")].predict(arguments)[0][0]
    risk = 0.0 if following is None else NEAR_BALL.subgoal_risk(arguments, np.array(following))[0]
    return Outcome(mean, std, own, in_spite, joule, 0.0 if math.isnan(risk) else risk)


def _known(value: float | None) -> float:
    """What a risk is told of the next action's parameter: NaN while it is free."""
    return math.nan if value is None else value


def cost(sequence: ActionSequence, values: Mapping[int, float], chosen: RefinementSettings) -> tuple[float, bool]:
    """Seconds, infinite if INVALID, and whether a limit is so near that rounding may decide."""
    total, near, before = 0.0, False, set[int]()
    for instance, following in zip(sequence.actions, [*sequence.actions[1:], None], strict=True):
        exact = [values.get(i, sequence.variables[i].value) for i in instance.variables]
        poses = following is not None and instance.asserted and following.action.subgoal_risk is not None
        goal = [_known(sequence.variables[i].value) for i in following.variables] if poses else None
        seen = [outcome(instance, row, goal) for row in arrivals(instance, exact, before, chosen)]
        mean = {name: sum(getattr(each, name) for each in seen) / len(seen) for name in Outcome.__annotations__}
        own = 1 - mean["own"] * (1 - mean["risk"])
        met_cost_s = 0.0
        if instance.action.context and chosen.risk_cost_s:
            met_cost_s = max(chosen.risk_cost_s, instance.action.context.failure_cost_s)
        total += mean["duration_s"] + chosen.k_std * mean["std_s"] + chosen.energy_weight * mean["joule"]
        total += chosen.risk_cost_s * own + met_cost_s * (1 - mean["in_spite"])
        worst = max(1 - each.own * each.in_spite for each in seen)
        limit = chosen.p_fail_max if instance.risk is None else instance.risk
        total, near = (math.inf if worst > limit else total), near or abs(worst - limit) < 1e-9
        before = set(instance.variables)
    return total, near


def drawn(rng: np.random.Generator) -> ActionSequence:
    """A drive, an approach and a dribble beside objects, each place with free quantities, perhaps with subgoals."""
    free = {"x": (-3.0, 3.0), "y": (-2.0, 2.0), "phi": (2.5, 4.5), "v": (0.0, 0.3)}
    bound = {"x": 0.4, "y": -0.3, "phi": 1.0, "v": 0.2}
    places = [bound | {"x": -2.5}]
    for _ in range(3):
        places.append({name: free[name] if rng.random() < 0.4 else bound[name] + rng.normal(0, 0.5) for name in bound})
        if rng.random() < 0.3:
            places[-1]["phi"] = (-PI, PI)
    rows = [tuple(rng.uniform((-2.5, -1.5, 0.05), (2.5, 1.5, 0.3))) for _ in range(rng.integers(0, 4))]
    given = beside_objects(rows, [replace(GO_AROUND, context=PRICED), NEAR_BALL, DRIBBLE], places)
    for position in (1, 0):
        if rng.random() < 0.5:
            given = with_subgoal(given, position)
    risks = [None, 0.3, 1.0, 1.0]
    return replace(given, actions=tuple(replace(each, risk=risks[rng.integers(4)]) for each in given.actions))


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_it_is_what_a_slow_evaluation_comes_to(seed):
    rng = np.random.default_rng(seed)
    spreads = [(), (("x", 0.05), ("y", 0.05), ("phi", 0.05), ("v", 0.05)), (("x", 2.0), ("phi", 9.0), ("v", 0.4))]
    chosen = RefinementSettings(
        k_std=float(rng.choice([0.0, 1.0, 2.5])),
        risk_cost_s=float(rng.choice([0.0, 6.0, 30.0])),
        energy_weight=float(rng.choice([0.0, 0.02])),
        p_fail_max=float(rng.choice([0.2, 0.9])),
        arrival_spread=spreads[rng.integers(3)],
    )
    sequence = drawn(rng)
    objective = SequenceObjective(sequence.actions, sequence.variables, LOADED, chosen)
    candidates = objective.ranges.draw(6, rng)
    together = sum(objective.costs(objective.stages, [candidates[:, stage.columns] for stage in objective.stages]))
    for candidate, found, joint in zip(candidates, objective(candidates), together, strict=True):
        expected, near = cost(sequence, objective.values(candidate), chosen)
        if not near:
            assert found == pytest.approx(expected, rel=1e-9)
            assert joint == pytest.approx(expected, rel=1e-9)
