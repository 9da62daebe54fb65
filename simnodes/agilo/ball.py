"""A ball of scene.xml on the simulated field."""

from __future__ import annotations

from collections.abc import Mapping

import mujoco

QUANTITIES = ("x", "y", "vx", "vy")
FAR_M = 50.0  # where a ball lies that the start does not place


class Ball:
    """One ball: its state, and its place on the floor.

    Attributes:
      name: "ball" or "ball2", as in the scene, in topics and in start values.
      names: Names of its start values, e.g. "ball_vx".
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, name: str = "ball") -> None:
        self.name = name
        self.names = names(name)
        self._radius_m: float = model.geom(name).size.item(0)
        # views into the state, looked up once: a look-up by name costs as much as a physics step
        self._qpos, self._qvel = data.joint(name).qpos, data.joint(name).qvel

    def state(self) -> tuple[float, float, float, float]:
        """Position (m) and velocity (m/s), map frame."""
        x, y, *_ = self._qpos.tolist()
        vx, vy, *_ = self._qvel.tolist()
        return x, y, vx, vy

    def place(self, values: Mapping[str, float]) -> None:
        """Put it on the floor, rolling without slip, where values such as ball_x say; what is left out stays."""
        if not any(name in values for name in self.names):
            return
        x, y, vx, vy = (values.get(name, old) for name, old in zip(self.names, self.state(), strict=True))
        self._qpos[:] = (x, y, self._radius_m, 1, 0, 0, 0)
        self._qvel[:] = (vx, vy, 0, -vy / self._radius_m, vx / self._radius_m, 0)


def names(ball: str) -> tuple[str, ...]:
    """Names of the start values of a ball."""
    return tuple(f"{ball}_{quantity}" for quantity in QUANTITIES)
