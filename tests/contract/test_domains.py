"""Every domain folder keeps the contract of executive.library.Domain: a new robot is judged by these tests first."""

from __future__ import annotations

import ast
import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from executive import domains, planning
from executive.core.context import Settings, make_context
from executive.library import Models
from models.features import SPACES
from models.runtime import load_robot
from schemas.codec import decode, encode
from schemas.topics import TOPICS
from simnodes.declaration import declaration
from tools import lockstep

NAMES = [pytest.param(name, id=name) for name in domains.DOMAINS]
ACTIONS = [
    pytest.param(name, action, id=f"{name}-{action}")
    for name in domains.DOMAINS
    for action in sorted({a.duration_model.split("/")[0] for a in domains.load(name).actions.values()})
]


def first_scenario(name, seed=0):
    return domains.load_scenario(name, domains.scenarios(name)[0], np.random.default_rng(seed))


@pytest.mark.parametrize("name", NAMES)
def test_every_action_of_the_pddl_has_an_executable_one_with_that_many_arguments(name):
    domain = domains.load(name)
    schemas = {schema.name: schema for schema in planning.parse_domain(domain.pddl).actions}
    assert domain.executables.keys() == schemas.keys()
    for pddl_name, executable in domain.executables.items():
        count = len(schemas[pddl_name].parameters)
        assert all(0 <= p.argument < count for p in domain.actions[executable].parameters)


@pytest.mark.parametrize("name", NAMES)
def test_every_parameter_has_a_finite_range_a_unit_and_a_name_of_its_own(name):
    for action in domains.load(name).actions.values():
        assert len({p.name for p in action.parameters}) == len(action.parameters)
        for parameter in action.parameters:
            assert math.isfinite(parameter.lower)
            assert math.isfinite(parameter.upper)
            assert parameter.lower < parameter.upper
            assert parameter.unit
        assert action.detour == "" or action.detour in domains.load(name).actions


@pytest.mark.parametrize("name", NAMES)
def test_every_scenario_composes_and_is_the_same_for_the_same_seed(name):
    domain = domains.load(name)
    models = Models(*load_robot(domain.robot))
    for scenario in domains.scenarios(name):
        drawn = domains.load_scenario(name, scenario, np.random.default_rng(3))
        assert drawn == domains.load_scenario(name, scenario, np.random.default_rng(3))
        make_context(domain, drawn[0], models, Settings(), "0" * 32)


@pytest.mark.parametrize("name", NAMES)
def test_models_know_every_argument_in_the_range_that_is_asked_for(name):
    domain = domains.load(name)
    durations, successes = load_robot(domain.robot)
    for action in domain.actions.values():
        assert action.duration_model in durations
        assert action.success_model in ("", *successes)
        arguments = durations[action.duration_model].card["arguments"]
        assert len(arguments) == len(action.parameters)
        rng = np.random.default_rng(1)
        rows = rng.uniform([p.lower for p in action.parameters], [p.upper for p in action.parameters], (500, 8))
        mean, spread = durations[action.duration_model].predict(action.arguments(rows))
        assert np.isfinite(mean).mean() > 0.99
        assert (spread[np.isfinite(spread)] >= 0).all()


@pytest.mark.parametrize("name", NAMES)
def test_features_are_finite_wherever_arguments_are(name):
    domain = domains.load(name)
    durations, _ = load_robot(domain.robot)
    rng = np.random.default_rng(2)
    for action in domain.actions.values():
        space = SPACES[durations[action.duration_model].card["features"]]
        lower, upper = ([getattr(p, bound) for p in action.parameters] for bound in ("lower", "upper"))
        rows = rng.uniform(lower, upper, (2000, len(lower)))
        rows[0] = 0.0
        rows[1, 4:] = rows[1, :4]  # there already
        assert np.isfinite(space(rows)).all()


@pytest.mark.parametrize("name", NAMES)
def test_the_executives_limits_lie_within_the_drivers_and_its_command_survives_the_bus(name):
    domain = domains.load(name)
    declared = declaration(domain.robot)
    assert domain.command_topic == declared.command_topic
    assert tuple(axis.name for axis in domain.axes) == declared.axes
    for axis, limit in zip(domain.axes, declared.limits, strict=True):
        assert limit.lower <= axis.lower < axis.upper <= limit.upper
    message = domain.message(tuple(axis.upper for axis in domain.axes), 5)
    assert isinstance(message, TOPICS[domain.command_topic].type)
    assert decode(type(message), encode(message)) == message


@pytest.mark.parametrize("name", NAMES)
def test_sensors_come_from_the_driver_and_those_required_can_grow_stale(name):
    domain = domains.load(name)
    assert set(domain.required) <= set(domain.sensors)
    assert all(TOPICS[topic].source == "driver" for topic in domain.sensors)
    assert all(TOPICS[topic].fresh_s is not None for topic in domain.required)


@pytest.mark.parametrize("name", NAMES)
def test_belief_is_named_finite_and_not_ready_before_the_first_percept(name):
    domain = domains.load(name)
    belief = domain.update(domain.initial_belief(), 100_000_000, (), tuple(0.0 for _ in domain.axes))
    assert not domain.ready(belief)
    values = domain.belief_values(belief)
    assert len(values) == len(domain.belief_names)
    assert np.isfinite(values).all()


@pytest.mark.parametrize(("name", "action"), ACTIONS)
def test_a_controller_is_deterministic_finite_and_changes_nothing_it_is_given(name, action):
    domain = domains.load(name)
    body = lockstep.new_body(domain)
    rng = np.random.default_rng(4)
    for _ in range(3):
        arguments = lockstep.sample_arguments(domain, action, rng)
        before = arguments.tobytes()
        first, again = (
            lockstep.run_action(body, domain, action, arguments, np.random.default_rng(5), traced=True)
            for _ in range(2)
        )
        assert arguments.tobytes() == before
        assert first.ticks.tobytes() == again.ticks.tobytes()
        commands = np.array([tick.command for tick in first.trace])
        assert commands.shape == (len(first.trace), len(domain.axes))
        assert np.isfinite(commands).all()


@pytest.mark.parametrize("name", NAMES)
def test_scenarios_are_listed_once_and_the_first_is_the_default(name):
    names = domains.scenarios(name)
    assert names
    assert all(a != b for a, b in pairwise(sorted(names)))
    scenario, start = first_scenario(name)
    assert scenario.name == names[0]
    assert np.isfinite(list(start.values())).all()


@pytest.mark.parametrize("folder", ["core", "planning", "refinement"])
def test_what_all_robots_share_names_none_of_them(folder):
    loaded = [domains.load(name) for name in domains.DOMAINS]
    words = {domain.robot for domain in loaded} | {f"domains.{name}" for name in domains.DOMAINS}
    words |= {topic for domain in loaded for topic in (domain.command_topic, *domain.sensors) if "_" in topic}
    words |= {name for domain in loaded for name in domain.actions if not name.islower()}
    for path in (Path(domains.__file__).parents[1] / folder).rglob("*.py"):
        said = spoken(path)
        assert [(word, text) for word in words for text in said if word in text] == [], path


def spoken(path):
    """Names and texts of a module that mean something to Python: comments and docstrings may give examples."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    prose = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    said = set()
    for node in ast.walk(tree):
        said |= {str(getattr(node, field)) for field in ("id", "attr", "arg", "name", "module") if hasattr(node, field)}
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in prose:
            said.add(node.value)
    return said
