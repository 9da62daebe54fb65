"""Environments of gymnasium over every robot: its own checker, equality with lock-step runs, rewards, refusals."""

import warnings
from functools import partial

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.utils.seeding import np_random

from tailor.executive import domains
from tailor.executive.composition import ExecutiveConfig, build_context
from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.budget import CheckBudget
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import domain_names
from tailor.tools.gym import env_ids, register_envs
from tailor.tools.lockstep.action_run import new_body, run_action
from tailor.tools.lockstep.run import SENDER, run_lockstep
from tailor.tools.lockstep.task_sampler import sampler_of
from tailor.tools.lockstep.worlds import make_world

FEW = 20  # checks of a tick: the refined choice matters little here
OWN_WARNINGS = ("infinity", "symmetric and normalized")  # beliefs have no bounds; commands are in units of the robot


def make(env_id, **options):
    return gymnasium.make(env_id, **options, **({"checks": FEW} if env_id.startswith("tailor/") else {}))


def followed(env, seed):
    """Observations, rewards and infos of an episode in which the agent sends what the controller would send."""
    observation, info = env.reset(seed=seed)
    observations, rewards, infos, over = [observation], [], [info], False
    while not over:
        observation, reward, terminated, truncated, info = env.step(infos[-1]["command"])
        observations.append(observation)
        rewards.append(reward)
        infos.append(info)
        over = terminated or truncated
    return observations, rewards, infos


def test_every_robot_has_two_environments():
    assert set(env_ids()) == {f"{kind}/{name}-v0" for name in domain_names() for kind in ("tailor", "tailor-action")}
    register_envs()  # again: nothing is registered twice
    assert set(env_ids()) <= gymnasium.registry.keys()


@pytest.mark.parametrize("env_id", env_ids())
def test_gymnasium_s_own_checker_accepts_it(env_id):
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        check_env(make(env_id).unwrapped, skip_render_check=True)
    texts = {str(each.message) for each in warned}
    assert {text for text in texts if not any(own in text for own in OWN_WARNINGS)} == set()


def test_the_executive_s_own_commands_repeat_its_run_bit_for_bit():
    env = make("tailor/arm-v0", scenario="letter-I")
    observations, rewards, infos = followed(env, seed=4)
    seed = infos[0]["seed"]
    context = build_context(ExecutiveConfig("arm", "letter-I", Settings(seed=seed)), SENDER)
    world = make_world(context.domain.robot, "letter-I", seed)
    run = run_lockstep(context, world, new_budget=partial(CheckBudget, FEW))
    assert (run.result, infos[-1]["result"]) == ("achieved", "achieved")
    ticks = run.status[-len(observations) :]
    assert [tuple(each["belief"]) for each in observations] == [status.belief for status in ticks]
    assert [info["action"] for info in infos] == [status.action for status in ticks]
    assert not run.status[-len(observations) - 1].action  # the tick before the first action
    assert sum(rewards) == pytest.approx(-infos[-1]["time_s"])


@pytest.mark.parametrize("domain", domain_names())
def test_an_action_s_own_controller_repeats_its_run_bit_for_bit(domain):
    env = make(f"tailor-action/{domain}-v0")
    observations, rewards, infos = followed(env, seed=5)
    loaded = domains.load(domain)
    name = next(iter(loaded.actions))
    generator, _ = np_random(5)
    rng = np.random.default_rng(generator.integers(2**63, size=2))
    arguments = sampler_of(loaded).sample(loaded.actions[name], rng)
    run = run_action(new_body(loaded), loaded, name, arguments, rng)
    assert (infos[-1]["done"], infos[-1]["failure"]) == (run.done, run.failure)
    assert np.array_equal([each["arguments"] for each in observations], run.ticks)
    assert sum(rewards) == pytest.approx(-run.duration_s)


@pytest.mark.parametrize("env_id", ["tailor/arm-v0", "tailor-action/soccer-v0"])
def test_equal_seeds_and_commands_give_equal_bits_in_another_environment(env_id):
    def episode():
        env = make(env_id)
        env.action_space.seed(1)
        observation, _ = env.reset(seed=8)
        seen = [np.concatenate(list(observation.values())).tobytes()]
        for _ in range(30):
            observation, reward, *_ = env.step(env.action_space.sample())
            seen.append((np.concatenate(list(observation.values())).tobytes(), reward))
        return seen

    one, other = episode(), episode()
    assert one == other
    assert len(set(one)) > 20


@pytest.mark.parametrize("env_id", ["tailor/arm-v0", "tailor-action/arm-v0"])
def test_standing_still_ends_at_the_time_limit(env_id):
    env = make(env_id, limit_s=2.0)
    env.reset(seed=1)
    total, over = 0.0, False
    while not over:
        _, reward, terminated, over, _ = env.step(np.zeros(env.action_space.shape))
        total += reward
        assert not terminated
    assert total == pytest.approx(-2.0)


def test_a_short_limit_does_not_bound_the_wait_for_the_first_action():
    """It ended in "no action starts": the first of soccer starts after 1.4 s."""
    env = make("tailor/soccer-v0", limit_s=1.0)
    env.reset(seed=1)
    steps, over = 0, False
    while not over:
        *_, over, _ = env.step(np.zeros(env.action_space.shape))
        steps += 1
    assert steps == 10


def test_a_failure_costs_the_rest_of_the_time_limit():
    env = make("tailor-action/kitchen-v0", action="goToPose")
    env.reset(seed=0)
    ahead = np.array([env.action_space.high[0], *np.zeros(env.action_space.shape[0] - 1)])
    total, over, info = 0.0, False, {}
    while not over:
        _, reward, over, _, info = env.step(ahead)
        total += reward
    assert info["failure"] == "touched furniture"
    assert info["time_s"] < 20.0
    assert total == pytest.approx(-40.0)


def test_a_task_that_fails_costs_the_rest_of_the_time_limit():
    env = make("tailor/arm-v0")
    env.reset(seed=2)
    total, over, info = 0.0, False, {}
    while not over:
        _, reward, terminated, truncated, info = env.step(np.zeros(2))  # each action exceeds its time
        total, over = total + reward, terminated or truncated
    assert terminated
    assert "repeated failure" in info["result"]
    assert info["time_s"] < 80.0
    assert total == pytest.approx(-90.0)


def test_commands_are_limited_and_nonsense_is_refused():
    env = make("tailor-action/arm-v0").unwrapped
    other = make("tailor-action/arm-v0").unwrapped
    for each, factor in ((env, 1.0), (other, 7.0)):
        each.reset(seed=3)
        each.step(each.action_space.high * factor)
    assert np.array_equal(env.step(env.action_space.low)[0]["belief"], other.step(env.action_space.low)[0]["belief"])
    for nonsense in (np.zeros(5), np.array([0.0, np.nan])):
        with pytest.raises(ValueError, match="expected 2 finite numbers"):
            env.step(nonsense)


def test_a_scenario_s_seed_can_be_chosen():
    env = make("tailor/arm-v0")
    _, info = env.reset(seed=1, options={"seed": 77})
    assert info["seed"] == 77


@pytest.mark.parametrize(
    ("env_id", "options", "fault"),
    [
        ("tailor/arm-v0", {"scenario": "letter-ß"}, "no scenario"),
        ("tailor/arm-v0", {"zoo": "/nowhere"}, "no action models"),
        ("tailor-action/arm-v0", {"action": "fly"}, "no action 'fly'"),
        ("tailor-action/arm-v0", {"limit_s": float("nan")}, "limit_s is nan, expected seconds above 0"),
        ("tailor-action/arm-v0", {"limit_s": float("inf")}, "limit_s is inf, expected seconds above 0, finite"),
        ("tailor/arm-v0", {"limit_s": 0}, "limit_s is 0, expected seconds above 0"),
    ],
)
def test_what_a_robot_does_not_have_is_refused_in_one_line(env_id, options, fault):
    with pytest.raises(UsageError, match=fault):
        make(env_id, **options)


@pytest.mark.parametrize("checks", [0, -5, 1.5, float("nan")])
def test_a_budget_with_which_no_action_starts_is_refused(checks):
    with pytest.raises(UsageError, match=r"checks is .*, expected a whole number, at least 1"):
        gymnasium.make("tailor/arm-v0", checks=checks)


@pytest.mark.parametrize("arguments", [[1.0, 2.0], [float("nan")] * 10, "x", [[0.0] * 10]])
def test_arguments_that_are_none_of_the_action_are_refused(arguments):
    """A body with positions that are not finite ran on, and returned rewards."""
    env = make("tailor-action/arm-v0")
    with pytest.raises(UsageError, match=r"arguments of reach are .*, expected 10 finite numbers"):
        env.reset(seed=1, options={"arguments": arguments})


@pytest.mark.parametrize("seed", [-1, 1.7, "x"])
def test_a_scenario_s_seed_that_is_none_is_refused(seed):
    with pytest.raises(UsageError, match=r"seed of the scenario is .*, expected a whole number, at least 0"):
        make("tailor/arm-v0").reset(options={"seed": seed})


@pytest.mark.parametrize(
    ("env", "options", "expected"),
    [
        ("tailor-action/arm-v0", {"argument": [0.0] * 10}, "arguments"),
        ("tailor/arm-v0", {"seed": 1, "goal": ""}, "seed"),
    ],
)
def test_an_option_of_reset_that_is_none_is_refused(env, options, expected):
    """A misspelt one was ignored, and what it was to set was drawn."""
    unknown = next(name for name in options if name != "seed")
    with pytest.raises(UsageError, match=f"options of reset: unknown '{unknown}', expected '{expected}' or none"):
        make(env).reset(options=options)
