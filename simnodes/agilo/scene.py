"""The AGILO robot, its ball and the floor as a MuJoCo model, built from primitives."""

from __future__ import annotations

import itertools
import math

import mujoco

from tailor.simnodes.agilo.physical_parameters import PhysicalParameters

TIMESTEP_S = 0.01  # contacts give way over 0.02 s; with 1 ms rolls, pushes and hits end within 3 cm

# What the model has not got, and a search of bounding boxes that costs more than the few pairs that it rules out.
UNUSED = ("spring", "damper", "equality", "limit", "frictionloss", "sensor", "midphase")


def _rail(p: PhysicalParameters) -> str:
    """Capsules along the arc, at the height of the ball's equator above the axle."""
    centre = p.rail_ahead_m + p.rail_radius_m
    radius = p.rail_radius_m + p.rail_thickness_m  # of the capsules' axes: their inner side is the arc
    height = p.ball_radius_m - p.wheel_radius_m
    step = 2 * p.rail_half_angle / p.rail_segments
    bends = [math.pi - p.rail_half_angle + i * step for i in range(p.rail_segments + 1)]
    points = [f"{centre + radius * math.cos(b):.9f} {radius * math.sin(b):.9f} {height:.9f}" for b in bends]
    return "\n".join(
        f'<geom class="rail" fromto="{a} {b}" size="{p.rail_thickness_m}"/>' for a, b in itertools.pairwise(points)
    )


def _wheel(p: PhysicalParameters, side: str, y: float) -> str:
    """An ellipsoid, not a cylinder: one contact point, so that turning on the spot does not scrub."""
    return f"""
    <body name="{side}" pos="0 {y} 0">
      <joint name="{side}" type="hinge" axis="0 1 0" armature="0.002"/>
      <geom type="ellipsoid" size="{p.wheel_radius_m} 0.02 {p.wheel_radius_m}" mass="{p.wheel_mass_kg}"
            friction="{p.wheel_friction} 0.001 0.0001" condim="3" priority="1" contype="1" conaffinity="1"/>
    </body>"""


def _robot(p: PhysicalParameters) -> str:
    yaw_inertia = p.chassis_mass_kg * (p.chassis_length_m**2 + p.chassis_width_m**2) / 12
    tilt_inertia = p.chassis_mass_kg * (p.chassis_length_m**2 + p.chassis_height_m**2) / 12
    half = f"{p.chassis_length_m / 2} {p.chassis_width_m / 2} {p.chassis_height_m / 2}"
    return f"""
  <body name="robot" pos="0 0 {p.wheel_radius_m}">
    <freejoint name="robot"/>
    <inertial pos="{p.mass_ahead_m} 0 {p.mass_above_m}" mass="{p.chassis_mass_kg}"
              diaginertia="{tilt_inertia} {tilt_inertia} {yaw_inertia}"/>
    <geom type="box" pos="{p.chassis_ahead_m} 0 {p.chassis_height_m / 2}" size="{half}"
          friction="0.2 0.001 0.0001" condim="3" priority="1" contype="2" conaffinity="4"/>
    <geom type="sphere" pos="{p.caster_ahead_m} 0 -0.0325" size="0.03" condim="1" priority="1"/>
    {_rail(p)}
    {_wheel(p, "left", p.track_m / 2)}
    {_wheel(p, "right", -p.track_m / 2)}
  </body>"""


def mjcf(p: PhysicalParameters) -> str:
    """The model as MJCF text.

    Collision bits: 1 floor, wheels, caster; 2 chassis and rail; 4 ball. The ball meets floor, chassis and rail.
    Friction and condim of a contact are the larger of both geoms unless one has a priority, so caster, wheels and
    rail have one.
    """
    flags = " ".join(f'{feature}="disable"' for feature in UNUSED)
    servo = f'kv="{p.servo_gain}" forcerange="-{p.servo_torque_nm} {p.servo_torque_nm}"'
    return f"""
<mujoco model="agilo">
  <compiler angle="radian"/>
  <option timestep="{TIMESTEP_S}" integrator="implicitfast" cone="elliptic" impratio="5"><flag {flags}/></option>
  <default>
    <default class="rail">
      <geom type="capsule" friction="{p.rail_friction} 0.001 0.0001" condim="3" priority="1"
            contype="2" conaffinity="4" mass="0"/>
    </default>
  </default>
  <worldbody>
    <geom name="floor" type="plane" size="0 0 1" contype="1" conaffinity="5"/>
    {_robot(p)}
    <body name="ball" pos="2 0 {p.ball_radius_m}">
      <freejoint name="ball"/>
      <geom type="sphere" size="{p.ball_radius_m}" mass="{p.ball_mass_kg}" condim="6"
            friction="{p.ball_friction} 0.001 {p.ball_rolling_m}" contype="4" conaffinity="3"/>
    </body>
  </worldbody>
  <actuator>
    <velocity joint="left" {servo}/>
    <velocity joint="right" {servo}/>
  </actuator>
</mujoco>"""


def compile_scene(p: PhysicalParameters) -> mujoco.MjModel:
    """The compiled model. qpos: robot 7, left, right, ball 7; qvel: robot 6, left, right, ball 6."""
    return mujoco.MjModel.from_xml_string(mjcf(p))
