"""Table of services: requests with a response, who serves them and who may call them."""

from __future__ import annotations

from dataclasses import dataclass

from tailor.schemas.roles import Role


@dataclass(frozen=True, slots=True)
class Service:
    """One row; `pattern` matches the keys of the service for every robot."""

    pattern: str
    server: Role
    callers: tuple[Role, ...] = ("people",)


SERVICES: dict[str, Service] = {
    "goal": Service("exec/goal", "executive"),
    "simulator": Service("*/sim/*", "driver"),  # reset, place, pause, step: simnodes/services.py
    "snapshot": Service("recorder/snapshot", "recorder"),
}
