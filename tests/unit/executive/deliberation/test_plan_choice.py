"""`plan_costs = "models"`: of several plans the one that the models predict to be executed fastest is executed."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.executive.planning import Objects
from tailor.executive.planning.semantics import large_formulas, state
from tailor.executive.replay import replay
from tailor.schemas.messages import ActionFinished, PlanReport
from tests.support.toy_domain import LineModel, line_context
from tests.unit.executive.deliberation.test_improvement import drive, messages_of, steps, three_places

PLACES = {"home": {"x": 0.0}, "a": {"x": 1.5}, "b": {"x": 0.5}, "c": {"x": 1.0}, "d": {"x": -0.3}}
PROBLEM = """
(define (problem tour) (:domain line) (:objects home a b c d)
  (:init (at home) (place a) (place b) (place c) (place d))
  (:goal (and (visited a) (visited b) (visited c) (visited d))))
"""
GOAL = "(and (visited a) (visited b) (visited c) (visited d))"


def tour(**settings):
    return line_context(Settings(**settings), PLACES, PROBLEM)


def length(order):
    xs = [0.0, *(PLACES[place]["x"] for place in order)]
    return sum(abs(b - a) for a, b in itertools.pairwise(xs))


def driven(context, budget=lambda: CheckBudget(500), goal=GOAL):
    states, published, ticks = drive(context, 999, 200, budget, goal)
    first = messages_of(published, PlanReport)[0][1]
    return states, [action[2] for action in steps(first)], messages_of(published, ActionFinished), ticks


def test_the_shortest_tour_is_chosen_and_driven():
    states, order, finished, _ = driven(tour(plan_costs="models"))
    assert length(order) == pytest.approx(min(map(length, itertools.permutations("abcd"))))
    assert states[-1].task.result == "achieved"
    assert len(finished) == 4


def test_by_steps_any_tour_does():
    states, order, finished, _ = driven(tour())
    assert length(order) > min(map(length, itertools.permutations("abcd")))
    assert states[-1].task.result == "achieved"
    assert len(finished) == 4


class Unknown(LineModel):
    """Knows nothing of the way to one place from home."""

    def __init__(self, x):
        self.x = x

    def predict(self, arguments):
        mean, std = super().predict(arguments)
        return np.where((arguments[:, 0] == 0.0) & (arguments[:, 1] == self.x), np.nan, mean), std


def test_a_plan_of_which_the_models_know_nothing_is_not_the_fastest():
    context = tour(plan_costs="models")
    first = PLACES[driven(tour())[1][0]]["x"]
    unknown = replace(context, models=Models({"slide/duration": Unknown(first)}, {}))
    _, order, _, _ = driven(unknown)
    known = [each for each in itertools.permutations("abcd") if PLACES[each[0]]["x"] != first]
    assert length(order) == pytest.approx(min(map(length, known)))


def test_the_choice_is_the_same_however_the_work_is_divided_and_is_replayed_bit_for_bit():
    context = tour(plan_costs="models")
    states, published, ticks = drive(context, 999, 300, lambda: CheckBudget(13), GOAL)
    report = messages_of(published, PlanReport)[0][1]
    assert [action[2] for action in steps(report)] == driven(context)[1]
    assert states[-1].task.result == "achieved"
    assert list(replay(tour(plan_costs="models"), ticks)) == published


def test_a_goal_over_many_objects_is_checked_in_portions(monkeypatch):
    made, before_check, real = [0], [], Objects.bindings

    def counted(objects, variables, binding):
        for inner in real(objects, variables, binding):
            made[0] += 1
            yield inner

    class MeteredBudget(CheckBudget):
        def spent(self):
            before_check.append(made[0])
            made[0] = 0
            return super().spent()

    monkeypatch.setattr(Objects, "bindings", counted)
    for module in (state, large_formulas):
        monkeypatch.setattr(module, "PORTION_PARTS", 8)
    goal = GOAL.replace("(visited d)", "(visited d) (forall (?s ?t ?u ?v ?w) (or (= ?s ?t) (not (= ?s ?t))))")
    states, order, _, _ = driven(tour(plan_costs="models"), lambda: MeteredBudget(500), goal)
    assert length(order) == pytest.approx(min(map(length, itertools.permutations("abcd"))))
    assert states[-1].task.result == "achieved"
    assert sum(before_check) > 2 * 5**5
    assert max(before_check) < 5**5 / 3


def test_a_plan_without_alternatives_stays():
    states, published, _ = drive(three_places(Settings(plan_costs="models")), seen_from=999)
    assert len(messages_of(published, ActionFinished)) == 3
    assert states[-1].task.result == "achieved"
