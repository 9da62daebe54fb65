"""Loads scene.xml and sets the parameters that differ between profiles, by name."""

from __future__ import annotations

from importlib import resources

import mujoco

from tailor.simnodes.agilo.physical_parameters import PhysicalParameters

WHEELS = ("left", "right")
RAIL = tuple(f"rail_{number}" for number in range(1, 10))


def load_scene(parameters: PhysicalParameters) -> mujoco.MjModel:
    """The compiled model of scene.xml with these parameters."""
    model = mujoco.MjModel.from_xml_string(resources.files(__package__).joinpath("scene.xml").read_text("utf-8"))
    model.opt.timestep = parameters.timestep_s
    for wheel in WHEELS:
        model.geom(wheel).friction[0] = parameters.wheel_friction
        servo = model.actuator(wheel)
        servo.gainprm[0] = parameters.servo_gain  # torque = gain · (set-point - velocity)
        servo.biasprm[2] = -parameters.servo_gain
    for segment in RAIL:
        model.geom(segment).friction[0] = parameters.rail_friction
    model.geom("ball").friction[2] = parameters.ball_rolling_m
    return model
