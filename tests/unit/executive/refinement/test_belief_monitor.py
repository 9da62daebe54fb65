"""The belief monitor detects exactly the changes that a new instantiation would show, with fewer look-ups."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tailor.executive.belief.angles import difference
from tailor.executive.interfaces.domain import Conflict
from tailor.executive.interfaces.values import Interval
from tailor.executive.refinement.belief_monitor import BeliefMonitor
from tailor.executive.refinement.instantiation import Pattern, instantiate
from tailor.executive.refinement.objective.sequence import Failure, InstantiatedAction
from tests.support.synthetic_models import LIBRARY
from tests.unit.executive.refinement.test_instantiation import paper_plan

TOLERANCES = {"x": 0.1, "y": 0.1, "phi": 0.2, "xg": 0.1, "yg": 0.1}


def tolerant(action):
    parameters = (replace(parameter, tolerance=TOLERANCES.get(parameter.name)) for parameter in action.parameters)
    return replace(action, parameters=tuple(parameters))


@dataclass
class ShiftingDomain:
    """The belief gives x and y of the robot and of the ball, which has not been seen if it has none, and a heading."""

    actions: dict[str, Any] = field(default_factory=lambda: {name: tolerant(LIBRARY[name]) for name in LIBRARY})
    executables: dict[str, str] = field(
        default_factory=lambda: {"approachball": "approachBall", "dribbleball": "dribbleBall"}
    )
    queries: int = 0

    def value(self, query):
        quantity, belief = query.quantity, query.belief
        self.queries += 1
        for fact in query.holds:
            if fact[0] == "ball" and belief["ball"] is None:
                raise Conflict("the ball has not been seen")
            values = belief.get(fact[0])
            if values is not None and quantity in values:
                return Interval(values[quantity], values[quantity])
        return Interval(-belief["width"], belief["width"]) if quantity == "phi" else None


def violated_by_definition(plan, domain, then, belief):
    """Instantiate anew and compare every value that has a tolerance."""
    now = instantiate(plan, domain, belief, None)
    if isinstance(now, Failure):
        return False
    current = {(a.step, a.action.name): a for a in now.actions}
    for action in then.actions:
        other = current.get((action.step, action.action.name))
        for parameter, old_id, new_id in zip(action.action.parameters, action.variables, other.variables, strict=True):
            old, new = then.variables[old_id].value, now.variables[new_id].value
            if None not in (parameter.tolerance, old, new) and abs(apart(parameter, old, new)) > parameter.tolerance:
                return True
    return False


def apart(parameter, old, new):
    return difference(old, new) if parameter.periodic else old - new


places = st.fixed_dictionaries({"x": st.sampled_from([0.0, 0.09, 0.11, 3.0]), "y": st.sampled_from([0.0, 0.05, 1.0])})
turned = st.fixed_dictionaries({"x": st.just(0.0), "y": st.just(0.0), "phi": st.sampled_from([-3.1, -2.9, 0.0, 3.1])})
beliefs = st.fixed_dictionaries(
    {
        "robot": places | turned,
        "ball": st.none() | places,
        "final": st.just({"x": 1.0}),
        "width": st.sampled_from([0.0, 2.0]),
    }
)
START = {"robot": {"x": 0.0, "y": 0.0, "phi": 3.1}, "ball": {"x": 3.0, "y": 0.0}, "final": {"x": 1.0}, "width": 0.0}


@given(belief=beliefs)
def test_violation_is_what_a_new_instantiation_shows(belief):
    plan, domain = paper_plan(), ShiftingDomain()
    then = instantiate(plan, domain, START, None)
    monitor = BeliefMonitor(Pattern(plan, domain, None), then)
    assert monitor.outdated(belief, {}) == violated_by_definition(plan, domain, then, belief)


@pytest.mark.parametrize(("phi", "violated"), [(3.05, False), (-3.1, False), (-2.95, True), (2.85, True)])
def test_headings_are_compared_modulo_a_full_turn(phi, violated):
    plan, domain = paper_plan(), ShiftingDomain()
    monitor = BeliefMonitor(Pattern(plan, domain, None), instantiate(plan, domain, START, None))
    assert monitor.outdated({**START, "robot": {**START["robot"], "phi": phi}}, {}) is violated


def test_moved_ball_is_a_violation_but_one_out_of_sight_is_not():
    plan, domain = paper_plan(), ShiftingDomain()
    monitor = BeliefMonitor(Pattern(plan, domain, None), instantiate(plan, domain, START, None))
    assert not monitor.outdated(START, {})
    assert monitor.outdated({**START, "ball": {"x": 3.0, "y": 0.2}}, {})
    assert not monitor.outdated({**START, "ball": None}, {})


def test_only_values_with_a_tolerance_are_looked_up():
    plan, domain = paper_plan(), ShiftingDomain()
    sequence = instantiate(plan, domain, START, None)
    monitor, domain.queries = BeliefMonitor(Pattern(plan, domain, None), sequence), 0
    monitor.outdated(START, {})
    monitored = {
        v for a in sequence.actions for p, v in zip(a.action.parameters, a.variables, strict=True) if p.tolerance
    }
    assert 0 < domain.queries <= len(monitored) < len(sequence.variables)


def test_asserted_subgoal_is_not_monitored():
    plan, domain = paper_plan(), ShiftingDomain()
    pattern = Pattern(plan, domain, None)
    sequence = pattern.sequence(START)
    first = sequence.actions[0]
    to_subgoal = InstantiatedAction(replace(first.action, name="goToPose"), first.step, first.variables, asserted=True)
    alone = replace(sequence, actions=(to_subgoal,))
    assert not BeliefMonitor(pattern, alone).outdated({**START, "ball": {"x": 9.0, "y": 9.0}}, {})
