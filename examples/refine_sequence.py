"""Chooses heading and speed at a waypoint, so that two actions together take the shortest time."""

import numpy as np

from tailor.executive import domains
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.refinement.objective.sequence import ActionSequence, InstantiatedAction, Variable
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.refinement import Refinement
from tailor.executive.robot_models import load_models

go = domains.load("soccer").actions["goToPose"]
known = {"start": (-2.0, 0.0, 0.0, 0.0), "waypoint": (0.0, 1.0, None, None), "goal": (-1.0, -1.0, 3.14, 0.0)}
variables: list[Variable] = []
for place, values in known.items():
    for parameter, value in zip(go.parameters[:4], values, strict=True):  # x, y, phi, v
        lower, upper = (parameter.lower, parameter.upper) if value is None else (value, value)
        row = (place, parameter.quantity, parameter.unit, lower, upper, parameter.periodic, value)
        variables.append(Variable(len(variables), *row))
actions = (InstantiatedAction(go, 1, tuple(range(8))), InstantiatedAction(go, 2, tuple(range(4, 12))))
sequence = ActionSequence(actions, tuple(variables))

refinement = Refinement(sequence, load_models("agilo"), RefinementSettings(), np.random.default_rng(0))
refinement.advance(CheckBudget(100))
choice, report = refinement.choice, refinement.report()
assert choice is not None, "the first check yields the greedy choice"
print(f"greedy {report.greedy_s:.2f} s, refined {report.best_s:.2f} s")
for variable in sequence.free():
    print(f"{variable.quantity} at {variable.label}: {choice.values[variable.id]:.2f} {variable.unit}")
