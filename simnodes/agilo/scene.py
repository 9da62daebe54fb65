"""Loads scene.xml and sets the parameters that differ between profiles, by name."""

from __future__ import annotations

from importlib import resources

import mujoco

from tailor.simnodes.agilo.physical_parameters import PhysicalParameters

WHEELS = ("left", "right")
RAIL = tuple(f"rail_{number}" for number in range(1, 10))


def load_scene(parameters: PhysicalParameters, second_ball: bool = False) -> mujoco.MjModel:
    """The compiled model of scene.xml with these parameters.

    A second ball is in a model of its own: one that lies idle would change the rounding of the others' motion.
    """
    spec = mujoco.MjSpec.from_string(resources.files(__package__).joinpath("scene.xml").read_text("utf-8"))
    if second_ball:
        _add_ball(spec, "ball2")
    model = spec.compile()
    model.opt.timestep = parameters.timestep_s
    for wheel in WHEELS:
        model.geom(wheel).friction[0] = parameters.wheel_friction
        servo = model.actuator(wheel)
        servo.gainprm[0] = parameters.servo_gain  # torque = gain · (set-point - velocity)
        servo.biasprm[2] = -parameters.servo_gain
    for segment in RAIL:
        model.geom(segment).friction[0] = parameters.rail_friction
    for ball in ("ball", "ball2")[: 1 + second_ball]:
        model.geom(ball).friction[2] = parameters.ball_rolling_m
    return model


def _add_ball(spec: mujoco.MjSpec, name: str) -> None:
    """A ball like the first, which meets it too."""
    first = spec.geom("ball")
    body = spec.worldbody.add_body(name=name, pos=(-2.0, 0.0, first.size[0]))
    body.add_freejoint(name=name)
    body.add_geom(
        name=name,
        type=first.type,
        size=first.size,
        mass=first.mass,
        condim=first.condim,
        friction=first.friction,
        contype=first.contype,
        conaffinity=first.conaffinity | first.contype,
        rgba=(0.9, 0.75, 0.1, 1.0),
    )
