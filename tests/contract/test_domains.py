"""Every domain that ships keeps the domain contract: one suite judges them all."""

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

from tailor.executive import domains, planning
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.domain import Scenario
from tailor.executive.refinement.instantiation import instantiate
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import domain_names
from tailor.schemas.topics import TOPICS
from tailor.simnodes.driver_spec import shipped_driver_spec
from tailor.tools.lockstep.action_run import new_body, newest, run_action, sample_arguments

ROOT = Path(__file__).resolve().parents[2]
PERIOD_NS = 100_000_000
EVERY = [pytest.param(name, id=name) for name in domain_names()]
ACTIONS = [
    pytest.param(name, action, id=f"{name}-{action}")
    for name in domain_names()
    for action in domains.load(name).actions
]
SCENARIOS = [
    pytest.param(name, scenario, id=f"{name}-{scenario}")
    for name in domain_names()
    for scenario in domains.scenarios(name)[:6]
]


def started(name, scenario, seed=0):
    """A scenario and a belief of it after three seconds of looking."""
    domain = domains.load(name)
    drawn, start = domains.load_scenario(name, scenario, np.random.default_rng([seed, 0]))
    body, belief, zero = new_body(domain), domain.initial_belief(), (0.0,) * len(domain.axes)
    body.reset(np.random.default_rng([seed, 1]), start)
    for tick in range(1, 31):
        body.command(zero)
        belief = domain.update(belief, tick * PERIOD_NS, newest(body.advance(PERIOD_NS)), zero)
    return domain, drawn, belief


@pytest.mark.parametrize("name", EVERY)
def test_declarations_are_complete_and_finite(name):
    domain = domains.load(name)
    assert domain.name == name
    assert domain.robot
    assert {*domain.sensors, domain.command_topic} <= TOPICS.keys()
    assert set(domain.required) <= set(domain.sensors)
    for action in domain.actions.values():
        assert action.duration_model.endswith("/duration")
        assert action.success_model == "" or action.success_model.endswith("/success")
        assert action.subgoal_action in ("", *domain.actions)
        assert len({p.name for p in action.parameters}) == len(action.parameters)
        for parameter in action.parameters:
            assert parameter.unit
            assert math.isfinite(parameter.lower)
            assert math.isfinite(parameter.upper)
            assert parameter.lower < parameter.upper
    assert all(axis.lower < axis.upper and axis.unit for axis in domain.axes)


@pytest.mark.parametrize("name", EVERY)
def test_symbolic_actions_have_executable_ones_with_arguments_that_exist(name):
    domain = domains.load(name)
    schemas = {schema.name: schema for schema in planning.parse_domain(domain.pddl).actions}
    assert set(schemas) == set(domain.executables)
    for symbolic, executable in domain.executables.items():
        for parameter in domain.actions[executable].parameters:
            assert 0 <= parameter.argument < len(schemas[symbolic].parameters)


@pytest.mark.parametrize("name", EVERY)
def test_driver_takes_what_the_domain_commands(name):
    domain = domains.load(name)
    declared = shipped_driver_spec(domain.robot)
    assert declared.command_topic == domain.command_topic
    assert declared.axes == tuple(axis.name for axis in domain.axes)
    for limit, axis in zip(declared.limits, domain.axes, strict=True):
        assert limit.lower <= axis.lower < axis.upper <= limit.upper
    spec = tomllib.loads((ROOT / "simnodes" / domain.robot / "driver.toml").read_text())
    for topic, sensor in spec["sensors"].items():
        assert TOPICS[topic].rate_hz == sensor["rate_hz"], topic


@pytest.mark.parametrize(("name", "action"), ACTIONS)
def test_sampled_arguments_are_finite_and_follow_the_seed(name, action):
    domain = domains.load(name)
    drawn = [[sample_arguments(domain, action, np.random.default_rng(seed)) for seed in range(20)] for _ in range(2)]
    assert np.isfinite(drawn).all()
    assert np.array_equal(drawn[0], drawn[1])
    assert np.ptp(drawn[0], axis=0).max() > 0.0


@pytest.mark.parametrize(("name", "action"), ACTIONS)
def test_arguments_of_a_batch_are_those_of_its_rows(name, action):
    action = domains.load(name).actions[action]
    rng = np.random.default_rng(3)
    values = rng.uniform(
        [p.lower for p in action.parameters], [p.upper for p in action.parameters], (50, len(action.parameters))
    )
    before = values.copy()
    batch = action.arguments(values)
    assert np.array_equal(values, before), "the caller's values are left alone"
    assert np.array_equal(batch, np.vstack([action.arguments(row[None, :]) for row in values]))


@pytest.mark.parametrize(("name", "action"), ACTIONS)
def test_controller_is_deterministic_and_its_commands_are_within_the_axes(name, action):
    domain = domains.load(name)
    body = new_body(domain)
    for number in range(3):
        arguments = sample_arguments(domain, action, np.random.default_rng([4, number]))
        first, second = (
            run_action(body, domain, action, arguments, np.random.default_rng([5, number]), traced=True)
            for _ in range(2)
        )
        assert np.array_equal(first.ticks, second.ticks)
        assert (first.duration_s, first.failure) == (second.duration_s, second.failure)
        assert first.done, first.failure
        for tick in first.trace:
            for value, axis in zip(tick.command, domain.axes, strict=True):
                assert axis.lower <= value <= axis.upper


@pytest.mark.parametrize(("name", "scenario"), SCENARIOS)
def test_scenario_follows_its_seed_and_is_finite(name, scenario):
    def drawn(seed):
        return domains.load_scenario(name, scenario, np.random.default_rng(seed))

    assert drawn(1) == drawn(1)
    made, start = drawn(2)
    assert isinstance(made, Scenario)
    values = [*start.values(), *(v for place in made.places.values() for v in place.values())]
    assert np.isfinite(values).all()


@pytest.mark.parametrize(("name", "scenario"), SCENARIOS)
def test_scenario_can_be_planned_and_instantiated_from_what_is_believed(name, scenario):
    domain, drawn, belief = started(name, scenario)
    assert domain.ready(belief)
    pddl = planning.parse_domain(domain.pddl)
    problem = planning.parse_problem(drawn.problem, pddl)
    facts = domain.anchor(belief, drawn, frozenset(problem.initial))
    plan = planning.Search(pddl, problem.with_initial(facts)).advance(CheckBudget(2000)).plan
    assert plan is not None
    sequence = instantiate(plan, domain, belief, drawn)
    assert isinstance(sequence, ActionSequence), sequence
    labels = {v.label for v in sequence.variables if v.value is None}
    assert labels or any(action.action.subgoal_action for action in sequence.actions), (
        "something is open, or may get a subgoal"
    )
    assert all(math.isfinite(v.lower) and math.isfinite(v.upper) for v in sequence.variables)


@pytest.mark.parametrize(("name", "scenario"), SCENARIOS[:1])
def test_belief_values_are_named_and_finite_before_and_after_percepts(name, scenario):
    domain, _, belief = started(name, scenario)
    assert not domain.ready(domain.initial_belief())
    for known in (domain.initial_belief(), belief):
        values = domain.belief_values(known)
        assert len(values) == len(domain.belief_names)
        assert np.isfinite(values).all()
    assert all("(" in label for label in domain.belief_names), "units"


@pytest.mark.parametrize("name", EVERY)
def test_command_becomes_a_message_of_the_topic(name):
    domain = domains.load(name)
    message = domain.message(tuple(0.1 for _ in domain.axes), 7)
    assert type(message) is TOPICS[domain.command_topic].type
    assert message.stamp_ns == 7


def test_unknown_names_are_refused_with_those_that_there_are():
    with pytest.raises(UsageError, match="soccer"):
        domains.load("chess")
    with pytest.raises(UsageError, match="approach-dribble"):
        domains.load_scenario("soccer", "penalty", np.random.default_rng(0))
    with pytest.raises(UsageError):
        domains.scenarios("chess")
