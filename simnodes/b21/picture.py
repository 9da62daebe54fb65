"""Pictures of the simulated kitchen, drawn by PyBullet's TinyRenderer on any machine: no display, no graphics card.

`python -m tailor.simnodes.b21.picture kitchen.png` draws the robot that takes a cup from a table.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

import numpy as np

from tailor.schemas.kitchen.furniture import kitchen, on_table
from tailor.schemas.kitchen.kinematics import JOINTS
from tailor.simnodes.b21.body import B21Body
from tailor.simnodes.b21.engine import pybullet

SIZE = (960, 600)  # pixels
EYE, TARGET = (-0.3, -2.9, 2.1), (-1.35, 0.25, 0.75)  # m, map frame
HALF_VIEW_DEG = 21.0
TAKING = (-0.302, 0.093, -1.491, 0.0, 1.398, 0.0)  # an arm above a cup at the table's edge


def draw(
    body: B21Body, eye: Sequence[float] = EYE, target: Sequence[float] = TARGET, size: tuple[int, int] = SIZE
) -> Any:
    """A picture of the world as it is now.

    Args:
      body: The simulated robot in its kitchen.
      eye, target: Where the camera is, and what it looks at, m in the map frame.
      size: Width and height in pixels.

    Returns:
      Array of shape (height, width, 3), dtype uint8.
    """
    bullet, (width, height) = pybullet(), size
    view = bullet.computeViewMatrix(eye, target, (0.0, 0.0, 1.0))
    projection = bullet.computeProjectionMatrixFOV(2 * HALF_VIEW_DEG, width / height, 0.1, 12.0)
    pixels = bullet.getCameraImage(
        width,
        height,
        view,
        projection,
        lightDirection=(2.0, -3.0, 6.0),
        shadow=1,
        renderer=bullet.ER_TINY_RENDERER,
        physicsClientId=body.client,
    )[2]
    return np.reshape(np.asarray(pixels, dtype=np.uint8), (height, width, 4))[:, :, :3]


def taking() -> B21Body:
    """A robot that has just lifted a cup from table1; others stand on their tables."""
    start: dict[str, float] = {"held": 1.0, **dict(zip(JOINTS, TAKING, strict=True))}
    start["x"], start["y"], start["phi"] = on_table(kitchen().tables["table1"], kitchen().edge_m + 0.55, 0.0, np.pi)
    for cup, (table, slot, handle) in kitchen().cups.items():
        place = on_table(kitchen().tables[table], *kitchen().table.slots[slot], handle)
        start |= {f"{cup}_{name}": value for name, value in zip(("x", "y", "phi"), place, strict=True)}
    body = B21Body()
    body.reset(np.random.default_rng(0), start)
    return body


if __name__ == "__main__":
    from matplotlib.image import imsave

    imsave(sys.argv[1], draw(taking()))
