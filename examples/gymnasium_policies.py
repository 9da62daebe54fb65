"""Compares three policies in an environment of gymnasium: the action's own controller, a cautious one, and chance.

Any installed robot will do: the environments are `tailor/DOMAIN-v0` and `tailor-action/DOMAIN-v0`.
"""

import sys
from collections.abc import Callable
from typing import Any

import gymnasium
from gymnasium.wrappers import RescaleAction

import tailor.tools.gym  # registers the environments

EPISODES, LIMIT_S = 3, 15.0
Policy = Callable[[dict[str, Any], dict[str, Any]], Any]  # observation and info to a command


def mean_return(env: Any, policy: Policy) -> float:
    """Mean sum of rewards of the same few episodes: minus the seconds to the goal."""
    total = 0.0
    for seed in range(EPISODES):
        observation, info = env.reset(seed=seed)
        over = False
        while not over:
            observation, reward, terminated, truncated, info = env.step(policy(observation, info))
            total, over = total + float(reward), terminated or truncated
    return total / EPISODES


def main(env_id: str) -> None:
    """Print the mean return of each policy."""
    env = gymnasium.make(env_id, limit_s=LIMIT_S)
    normalised = RescaleAction(env, -1.0, 1.0)  # commands from -1 to 1, as learners prefer them
    normalised.action_space.seed(0)
    print(f"controller  {mean_return(env, lambda observation, info: info['command']):6.2f}")
    print(f"cautious    {mean_return(env, lambda observation, info: 0.8 * info['command']):6.2f}")
    print(f"chance      {mean_return(normalised, lambda observation, info: normalised.action_space.sample()):6.2f}")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else tailor.tools.gym.env_ids()[-1])
