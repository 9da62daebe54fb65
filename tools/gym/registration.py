"""Ids of the environments: two for each robot that can be simulated."""

from __future__ import annotations

import gymnasium

from tailor.schemas.installed import domain_names, spec_of

TASK, ACTION = "tailor", "tailor-action"  # namespaces
ENTRY_POINTS = {
    TASK: ("body", "tailor.tools.gym.task_env:TaskEnv"),
    ACTION: ("sampler", "tailor.tools.gym.action_env:ActionEnv"),
}


def env_ids() -> tuple[str, ...]:
    """Ids for `gymnasium.make`, in alphabetical order of domains; packages with faults have none."""
    return tuple(env_id for env_id, _, _ in _environments())


def register_envs() -> None:
    """Register the environments of all installed packages; those that are registered stay."""
    for env_id, entry_point, domain in _environments():
        if env_id not in gymnasium.registry:
            gymnasium.register(env_id, entry_point, kwargs={"domain": domain})


def _environments() -> list[tuple[str, str, str]]:
    """Id, entry point and domain of each environment whose parts a package names."""
    return [
        (f"{namespace}/{domain}-v0", entry_point, domain)
        for domain in domain_names()
        for namespace, (needed, entry_point) in ENTRY_POINTS.items()
        if spec_of(domain).body and getattr(spec_of(domain), needed)
    ]
