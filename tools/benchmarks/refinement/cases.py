"""Tasks of the refinement benchmark: waypoint sequences of AGILO, and an approach that needs a subgoal."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from tailor.executive import domains
from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.assertion.assertion import Assertion
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence, InstantiatedAction, Variable
from tailor.executive.refinement.objective.settings import RefinementSettings

LEGS = {
    "2 free": 2,
    "4 free": 3,
    "8 free": 5,
    "12 free": 7,
    "24 free": 13,
}  # case -> legs of goToPose, two free parameters at each waypoint


@dataclass(frozen=True)
class Case:
    """One sequence to refine, with the initial candidates from assertion."""

    name: str
    actions: tuple[InstantiatedAction, ...]
    variables: tuple[Variable, ...]
    starts: tuple[Mapping[int, float], ...] = ()

    def objective(self, models: Models, settings: RefinementSettings | None = None) -> SequenceObjective:
        """Predicted cost of the sequence, with the default settings if none are given."""
        return SequenceObjective(self.actions, self.variables, models, settings or RefinementSettings())


def cases(models: Models, count: int, seed: int = 0) -> dict[str, list[Case]]:
    """`count` random tasks for each case."""
    library = domains.load("soccer").actions
    tasks = {
        name: [_waypoints(library["goToPose"], legs, np.random.default_rng([seed, legs, i])) for i in range(count)]
        for name, legs in LEGS.items()
    }
    tasks["5 free, subgoal"] = [
        _needs_subgoal(library, models, np.random.default_rng([seed, 6, i])) for i in range(count)
    ]
    return tasks


def _waypoints(action: Action, legs: int, rng: np.random.Generator) -> Case:
    places = [_place(rng, {"phi": rng.uniform(-3, 3), "v": 0.0})]
    places += [_place(rng, {}) for _ in range(legs - 1)]
    places.append(_place(rng, {"phi": rng.uniform(-3, 3), "v": 0.0}))
    return _chain("waypoints", [action] * legs, places)


def _needs_subgoal(library: Mapping[str, Action], models: Models, rng: np.random.Generator) -> Case:
    """An approach of the ball before which assertion asserts a subgoal, then the dribble."""
    actions = [library["approachBall"], library["dribbleBall"]]
    while True:
        pose = {"phi": rng.uniform(-3, 3), "v": 0.0}
        drawn = _chain("subgoal", actions, [_place(rng, pose), _place(rng, pose), _place(rng, pose)])
        free = [replace(v, value=None, lower=0.0, upper=0.3) if v.id == 7 else v for v in drawn.variables]
        given = ActionSequence(drawn.actions, tuple(free), library)
        asserted = Assertion(given, models, RefinementSettings(), rng).advance(CheckBudget(1000))
        if isinstance(asserted, ActionSequence) and len(asserted.actions) == 3:
            return Case("subgoal", asserted.actions, asserted.variables, asserted.starts)


def _place(rng: np.random.Generator, values: dict[str, float]) -> dict[str, float]:
    return {"x": float(rng.uniform(-2.5, 2.5)), "y": float(rng.uniform(-1.7, 1.7)), **values}


def _chain(name: str, actions: list[Action], places: list[dict[str, float]]) -> Case:
    """Actions from place to place; quantities missing in a place are free in the parameter's range."""
    variables: list[Variable] = []
    ids = []
    for at, place in enumerate(places):
        action = actions[min(at, len(actions) - 1)]
        parameters = [p for p in action.parameters if p.argument == min(q.argument for q in action.parameters)]
        ids.append(tuple(range(len(variables), len(variables) + len(parameters))))
        for parameter in parameters:
            free = parameter.quantity not in place
            variable = Variable(len(variables), f"pos{at}", parameter.quantity, parameter.unit, parameter.lower,
                                parameter.upper, parameter.periodic, None)  # fmt: skip
            variables.append(variable if free else variable.bound_to(place[parameter.quantity]))
    instances = tuple(InstantiatedAction(action, i + 1, ids[i] + ids[i + 1]) for i, action in enumerate(actions))
    return Case(name, instances, tuple(variables))
