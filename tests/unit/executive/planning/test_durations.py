"""The validator's own evaluation of durations agrees with the search's, which it does not share."""

import math
import random

import pytest

from tailor.executive.planning.ground.durations import duration_range
from tailor.executive.planning.ground.grounding import static_world
from tailor.executive.planning.pddl.language import DurationBound, Function, Number, Operation
from tailor.executive.planning.plans.durations import allowed_durations
from tests.support.planning_problems import own

VALUES = {("distance", "a", "b"): 4.0, ("speed",): 0.5, ("zero",): 0.0}
BINDING = {"?from": "a", "?to": "b"}


def allowed(*bounds):
    return allowed_durations(tuple(DurationBound(*bound) for bound in bounds), BINDING, VALUES)


def test_a_duration_is_worked_out_from_static_functions():
    distance, speed = Function("distance", ("?from", "?to")), Function("speed", ())
    assert allowed(("=", Operation("/", (distance, speed)))) == (8.0, 8.0)
    assert allowed((">=", distance), ("<=", Number(10.0))) == (4.0, 10.0)
    assert allowed((">=", Operation("-", (Number(1.0), distance, speed)))) == (0.0, math.inf)
    assert allowed() == (0.0, math.inf)


@pytest.mark.parametrize(
    "bounds",
    [
        [("=", Function("distance", ("?to", "?from")))],
        [("=", Operation("/", (Number(1.0), Function("zero", ()))))],
        [(">=", Number(5.0)), ("<=", Number(4.0))],
    ],
)
def test_no_value_a_division_by_zero_or_an_empty_interval_allow_no_duration(bounds):
    assert allowed(*bounds) is None


def numeric(rng, depth):
    if depth == 0 or rng.random() < 0.3:
        leaf = rng.choice([Number(rng.choice([0.0, 1.0, -2.5, 1e9])), *(Function(n, t) for n, *t in VALUES)])
        return Function(leaf.name, tuple(leaf.terms)) if isinstance(leaf, Function) else leaf
    return Operation(rng.choice("+-*/"), tuple(numeric(rng, depth - 1) for _ in range(rng.randint(2, 4))))


def test_validator_and_search_agree_on_random_durations():
    _, problem = own("soccer-durative-p1")
    world, rng = static_world(problem), random.Random(1)
    world = type(world)(world.domain, world.objects, world.static, world.facts, VALUES, world.temporal)
    for _ in range(500):
        bounds = tuple(DurationBound(rng.choice(["=", "<=", ">="]), numeric(rng, 3)) for _ in range(rng.randint(1, 3)))
        assert allowed_durations(bounds, BINDING, VALUES) == duration_range(bounds, BINDING, world)
