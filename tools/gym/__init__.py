"""Environments of gymnasium for every installed robot; importing this package registers them.

`tailor/DOMAIN-v0` pursues the goal of a scenario, `tailor-action/DOMAIN-v0` is one action. Needs the extra `gym`.
"""

from __future__ import annotations

try:
    import gymnasium  # noqa: F401
except ModuleNotFoundError as error:
    needs = "tailor.tools.gym needs the extra gym: pip install 'tailor[gym]'"
    raise ModuleNotFoundError(needs, name="gymnasium") from error

from tailor.tools.gym.action_env import ActionEnv
from tailor.tools.gym.registration import env_ids, register_envs
from tailor.tools.gym.task_env import TaskEnv

__all__ = ["ActionEnv", "TaskEnv", "env_ids", "register_envs"]

register_envs()
