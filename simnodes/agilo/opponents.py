"""Opponents on the field: standing cylinders of scene.xml, which block robot and ball.

One that no start value places lies outside the field and collides with nothing: the physics is that of an empty field.
"""

from __future__ import annotations

from collections.abc import Mapping

import mujoco

from tailor.schemas.messages.soccer import Opponent, OpponentsTruth

COUNT = 4
RADIUS_M, MAX_RADIUS_M = 0.2, 2.0
QUANTITIES = ("x", "y", "radius")
BODIES = tuple(f"opponent{number}" for number in range(1, COUNT + 1))
NAMES = tuple(f"{body}_{quantity}" for body in BODIES for quantity in QUANTITIES)
SOLID = 4  # collision bits of scene.xml: chassis, rail and ball meet these


def refusal(values: Mapping[str, float]) -> str:
    """What is wrong with radii among start values; empty if nothing is."""
    for name in (f"{body}_radius" for body in BODIES):
        if not 0.0 < values.get(name, RADIUS_M) <= MAX_RADIUS_M:
            return f"{name} is {values[name]:g} m, expected above 0 and at most {MAX_RADIUS_M:g}"
    return ""


class Opponents:
    """The opponents of one simulated field.

    Attributes:
      standing: Place and radius (m, map frame) of those on the field, by body.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self._model, self._data = model, data
        self._mocap = {body: model.body(body).mocapid.item() for body in BODIES}
        self._geoms = {body: model.geom(body).id for body in BODIES}
        self._robot = frozenset(
            geom for geom in range(model.ngeom) if model.geom_bodyid[geom] == model.body("robot").id
        )
        self._parked = {body: model.body(body).pos.copy() for body in BODIES}
        self.standing: dict[str, Opponent] = {}
        self._touched = False  # since the last report

    def reset(self) -> None:
        """Clear the field."""
        self.standing, self._touched = {}, False
        for body in BODIES:
            self._data.mocap_pos[self._mocap[body]] = self._parked[body]
            self._set_solid(body, False)

    def place(self, values: Mapping[str, float]) -> None:
        """Put opponents where values such as opponent1_x say; what is left out stays, or is 0 and RADIUS_M at first."""
        for body in BODIES:
            given = {name: values[key] for name in QUANTITIES if (key := f"{body}_{name}") in values}
            if given:
                old = self.standing.get(body, Opponent(0.0, 0.0, RADIUS_M))
                new = Opponent(given.get("x", old.x), given.get("y", old.y), given.get("radius", old.radius_m))
                self._stand(body, new)

    def take_over(self, others: Opponents) -> None:
        """Stand as in another model of the field."""
        self.reset()
        for body, opponent in others.standing.items():
            self._stand(body, opponent)
        self._touched = others._touched

    def watch(self) -> None:
        """Notice whether the robot touches an opponent in the present step."""
        if not self.standing or self._touched:
            return
        pairs = self._data.contact.geom[: self._data.ncon].tolist()
        solid = {self._geoms[body] for body in self.standing}
        self._touched = any((a in solid and b in self._robot) or (b in solid and a in self._robot) for a, b in pairs)

    def truth(self, now_ns: int) -> OpponentsTruth | None:
        """Where they stand, and whether the robot has touched one since the last call; None on an empty field."""
        if not self.standing:
            return None
        touched, self._touched = self._touched, False
        return OpponentsTruth(now_ns, touched, tuple(self.standing.values()))

    def _stand(self, body: str, opponent: Opponent) -> None:
        geom, half_height = self._geoms[body], self._model.geom(body).size.item(1)
        self.standing[body] = opponent
        self._data.mocap_pos[self._mocap[body]] = (opponent.x, opponent.y, half_height)
        self._model.geom_size[geom][0] = opponent.radius_m
        # what MuJoCo derives from the size when it compiles a model: bounding sphere and box
        self._model.geom_rbound[geom] = (opponent.radius_m**2 + half_height**2) ** 0.5
        self._model.geom_aabb[geom][3:5] = opponent.radius_m
        self._set_solid(body, True)

    def _set_solid(self, body: str, solid: bool) -> None:
        geom, at, bits = self._geoms[body], self._model.body(body).id, SOLID if solid else 0
        self._model.geom_contype[geom] = self._model.geom_conaffinity[geom] = bits
        self._model.body_contype[at] = self._model.body_conaffinity[at] = bits  # of all its geoms
