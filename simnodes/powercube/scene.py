"""The PowerCube arm as a MuJoCo model, built from primitives. Nothing touches anything: it writes in the air."""

from __future__ import annotations

import mujoco

from tailor.simnodes.powercube.physical_parameters import MODULES, WRITING, Module, PhysicalParameters

TIMESTEP_S = 0.001
PEN = "pen"  # the site at the tip


def _joint(p: PhysicalParameters, module: Module) -> str:
    axis = " ".join(map(str, module.axis))
    if module.name in WRITING:
        rotor = p.rotor_kgm2 * p.gear**2
        return f"""<joint name="{module.name}" axis="{axis}" armature="{rotor}" damping="{p.viscous_nms}"
                frictionloss="{p.coulomb_nm}"/>"""
    stiffness = p.brake_nm_per_rad
    return f"""<joint name="{module.name}" axis="{axis}" armature="0.1" stiffness="{stiffness}"
                damping="{stiffness / 100}" springref="{module.rest_rad}"/>"""


def _module(p: PhysicalParameters, index: int, ahead_m: float) -> str:
    module = MODULES[index]
    last = index + 1 == len(MODULES)
    inner = f'<site name="{PEN}" pos="{module.length_m} 0 0"/>' if last else _module(p, index + 1, module.length_m)
    tip = f'<geom type="sphere" pos="{module.length_m} 0 0" size="0.012" mass="{p.pen_kg}"/>' if last else ""
    half = max(module.length_m / 2, 0.001)
    link_kg = p.link_kg_per_m * module.length_m + 1e-3
    return f"""
  <body name="{module.name}" pos="{ahead_m} 0 0">
    {_joint(p, module)}
    <geom type="sphere" size="{module.radius_m}" mass="{module.mass_kg}"/>
    <geom type="capsule" fromto="0 0 0 {2 * half} 0 0" size="{0.5 * module.radius_m}" mass="{link_kg}"/>
    {tip}
    {inner}
  </body>"""


def mjcf(p: PhysicalParameters) -> str:
    """The model as MJCF text; the arm stretches along x, one motor for each writing joint, in N·m."""
    motors = "\n".join(f'<motor joint="{name}"/>' for name in WRITING)
    return f"""
<mujoco model="powercube">
  <compiler angle="radian"/>
  <option timestep="{TIMESTEP_S}" integrator="implicitfast"><flag contact="disable"/></option>
  <worldbody>
    <body name="shoulder" pos="0 0 {p.shoulder_height_m}">{_module(p, 0, 0.0)}
    </body>
  </worldbody>
  <actuator>{motors}</actuator>
</mujoco>"""


def compile_scene(p: PhysicalParameters) -> mujoco.MjModel:
    """The compiled model. qpos and qvel: one number a module, in the order of MODULES."""
    return mujoco.MjModel.from_xml_string(mjcf(p))
