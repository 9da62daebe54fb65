"""The cups of one world: created when they are first placed, they stand, tip, fall and roll."""

from __future__ import annotations

import math
from typing import Any

from tailor.schemas.kitchen.furniture import kitchen
from tailor.schemas.messages.kitchen import KitchenObject
from tailor.simnodes.b21.engine import pybullet
from tailor.simnodes.b21.physical_parameters import PhysicalParameters

COLOURS = ((0.85, 0.25, 0.20, 1.0), (0.20, 0.45, 0.80, 1.0), (0.95, 0.75, 0.20, 1.0))


class Cups:
    """Cups by name.

    Attributes:
      bodies: Body in PyBullet of each cup that is in the kitchen.
    """

    def __init__(self, client: int, parameters: PhysicalParameters) -> None:
        """A kitchen without cups."""
        self._bullet, self._parameters = pybullet(), parameters
        self._where: dict[str, Any] = {"physicsClientId": client}
        self.bodies: dict[str, int] = {}

    def stand(self, name: str, x: float, y: float, phi: float, bottom: float) -> None:
        """Put a cup upright and at rest on what is `bottom` m high."""
        if name not in self.bodies:
            self.bodies[name] = self._create(name)
        at = (x, y, bottom + kitchen().cup.height / 2)
        turned = (0.0, 0.0, math.sin(phi / 2), math.cos(phi / 2))
        self._bullet.resetBasePositionAndOrientation(self.bodies[name], at, turned, **self._where)
        self._bullet.resetBaseVelocity(self.bodies[name], (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), **self._where)

    def push(self, name: str, vx: float, vy: float) -> None:
        """Give a cup a velocity, m/s in the map frame."""
        _, turning = self._bullet.getBaseVelocity(self.bodies[name], **self._where)
        self._bullet.resetBaseVelocity(self.bodies[name], (vx, vy, 0.0), turning, **self._where)

    def object(self, name: str) -> KitchenObject:
        """Where a cup's middle is, where its handle points, and how much it leans."""
        (x, y, z), (i, j, k, w) = self._bullet.getBasePositionAndOrientation(self.bodies[name], **self._where)
        upright = max(-1.0, min(1.0, 1 - 2 * (i * i + j * j)))
        phi = math.atan2(2 * (w * k + i * j), 1 - 2 * (j * j + k * k))
        return KitchenObject(name, x, y, z, phi, math.acos(upright))

    def objects(self) -> tuple[KitchenObject, ...]:
        """All cups in the kitchen."""
        return tuple(self.object(name) for name in sorted(self.bodies))

    def _create(self, name: str) -> int:
        cup, bullet = kitchen().cup, self._bullet
        long, wide, tall = cup.handle
        kinds, centres = [bullet.GEOM_CYLINDER, bullet.GEOM_BOX], [(0, 0, 0), (cup.radius + long / 2, 0, 0)]
        shape: dict[str, Any] = {
            "radii": [cup.radius, 0.0],
            "lengths": [cup.height, 0.0],
            "halfExtents": [(0, 0, 0), (long / 2, wide / 2, tall / 2)],
        }
        solid = bullet.createCollisionShapeArray(kinds, collisionFramePositions=centres, **shape, **self._where)
        seen = bullet.createVisualShapeArray(kinds, visualFramePositions=centres, **shape, **self._where)
        body: int = bullet.createMultiBody(cup.mass_kg, solid, seen, **self._where)
        colour = COLOURS[list(kitchen().cups).index(name) % len(COLOURS)]
        bullet.changeVisualShape(body, -1, rgbaColor=colour, **self._where)
        p = self._parameters
        bullet.changeDynamics(
            body,
            -1,
            lateralFriction=p.cup_friction,
            rollingFriction=p.rolling_friction_m,
            spinningFriction=p.rolling_friction_m,
            restitution=p.bounce,
            linearDamping=0.0,
            angularDamping=0.05,
            **self._where,
        )
        return body
