"""The scenes are MJCF files that MuJoCo opens by itself, with the names and sizes that the bodies rely on."""

import math
from pathlib import Path

import mujoco
import numpy as np
import pytest

from tailor.simnodes.agilo import dimensions
from tailor.simnodes.agilo.physical_parameters import PhysicalParameters
from tailor.simnodes.agilo.profiles import PROFILES
from tailor.simnodes.agilo.scene import RAIL, load_scene
from tailor.simnodes.powercube.physical_parameters import NAMES, WRITING

FOLDER = Path(__file__).resolve().parents[3] / "simnodes"
RAIL_RADIUS_M, RAIL_HALF_ANGLE, RAIL_THICKNESS_M = 0.118, 1.3265, 0.005


def scene(robot):
    return mujoco.MjModel.from_xml_path(str(FOLDER / robot / "scene.xml"))


@pytest.mark.parametrize("robot", ["agilo", "powercube"])
def test_the_file_opens_and_steps_without_our_code(robot):
    model = scene(robot)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=100)
    assert np.isfinite(data.qpos).all()


def test_nominal_parameters_are_those_of_the_file():
    file, nominal = scene("agilo"), load_scene(PhysicalParameters())
    for name in ("geom_friction", "actuator_gainprm", "actuator_biasprm", "body_mass", "geom_size"):
        assert np.array_equal(getattr(file, name), getattr(nominal, name)), name
    assert file.opt.timestep == nominal.opt.timestep


def test_the_degraded_profile_sets_its_parameters_by_name():
    model = load_scene(PROFILES["degraded"][0])
    assert {model.geom(wheel).friction[0] for wheel in ("left", "right")} == {0.7}
    assert {model.geom(segment).friction[0] for segment in RAIL} == {0.13}
    assert model.geom("ball").friction[2] == 0.0092
    servo = model.actuator("left")
    assert (servo.gainprm[0], servo.biasprm[2]) == (0.8, -0.8)


def test_dimensions_are_those_of_the_file():
    model = scene("agilo")
    assert model.geom("left").size[0] == model.body("robot").pos[2] == dimensions.WHEEL_RADIUS_M
    assert model.body("left").mass[0] == dimensions.WHEEL_MASS_KG
    assert model.joint("left").armature[0] == dimensions.WHEEL_ARMATURE_KGM2
    assert model.body("left").pos[1] - model.body("right").pos[1] == dimensions.TRACK_M
    assert model.body("robot").mass[0] == dimensions.CHASSIS_MASS_KG
    assert model.body("robot").ipos[0] == dimensions.MASS_AHEAD_M
    assert model.geom("ball").size[0] == dimensions.BALL_RADIUS_M
    length, width, height = 2 * model.geom("chassis").size
    assert (length, width) == (dimensions.CHASSIS_LENGTH_M, dimensions.CHASSIS_WIDTH_M)
    squares = np.array([length**2 + height**2, length**2 + height**2, length**2 + width**2])
    assert sorted(model.body("robot").inertia) == pytest.approx(sorted(dimensions.CHASSIS_MASS_KG * squares / 12))


def test_the_rail_is_an_arc_around_the_ball():
    model = scene("agilo")
    data = mujoco.MjData(model)
    mujoco.mj_resetData(model, data)
    data.joint("robot").qpos[:] = (0, 0, 0, 1, 0, 0, 0)
    mujoco.mj_forward(model, data)
    centre = dimensions.RAIL_AHEAD_M + RAIL_RADIUS_M
    ends = []
    for segment in RAIL:
        geom, half = data.geom(segment), model.geom(segment).size[1]
        axis = geom.xmat.reshape(3, 3)[:, 2]
        ends += [geom.xpos - half * axis, geom.xpos + half * axis]
    radii = [math.hypot(x - centre, y) for x, y, _ in ends]
    assert radii == pytest.approx([RAIL_RADIUS_M + RAIL_THICKNESS_M] * len(ends), abs=1e-8)
    assert max(abs(math.atan2(y, centre - x)) for x, y, _ in ends) == pytest.approx(RAIL_HALF_ANGLE, abs=1e-8)
    assert [z for *_, z in ends] == pytest.approx([dimensions.BALL_RADIUS_M - dimensions.WHEEL_RADIUS_M] * len(ends))


def test_the_arms_joints_and_motors_have_the_names_of_its_messages():
    model = scene("powercube")
    assert tuple(model.joint(number).name for number in range(model.njnt)) == NAMES
    assert tuple(model.actuator(number).name for number in range(model.nu)) == WRITING
