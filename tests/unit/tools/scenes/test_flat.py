"""A scene on a plane: places and outlines, from above and from behind."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tailor.schemas.packages.pose3 import Pose3, on_plane, turned
from tailor.schemas.packages.scene import BASE, Scene, box, cylinder, frame, line, on_map, sphere, text
from tailor.tools.scenes.flat import flat

ANGLES = st.floats(-math.pi, math.pi)
NUMBERS = st.floats(-5.0, 5.0)


@st.composite
def poses(draw):
    x, y, z, a, b = draw(NUMBERS), draw(NUMBERS), draw(NUMBERS), draw(ANGLES), draw(ANGLES)
    return turned((0.0, 0.0, 1.0), a, (x, y, z)).then(turned((0.0, 1.0, 0.0), b))


def matrix(pose: Pose3):
    """Homogeneous matrix by the textbook's formula of a quaternion."""
    x, y, z, w = pose.qx, pose.qy, pose.qz, pose.qw
    turn = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    whole = np.eye(4)
    whole[:3, :3], whole[:3, 3] = turn, (pose.x, pose.y, pose.z)
    return whole


@given(poses(), poses())
def test_poses_compose_as_their_matrices_do(one, other):
    np.testing.assert_allclose(matrix(one.then(other)), matrix(one) @ matrix(other), atol=1e-9)
    np.testing.assert_allclose(matrix(one.inverse()) @ matrix(one), np.eye(4), atol=1e-9)


@given(poses(), st.tuples(NUMBERS, NUMBERS, NUMBERS))
def test_points_move_with_a_pose(pose, point):
    np.testing.assert_allclose(pose.moved(point), (matrix(pose) @ (*point, 1.0))[:3], atol=1e-9)


@given(NUMBERS, NUMBERS, ANGLES)
def test_the_outline_of_a_part_of_the_robot_does_not_move_with_it(x, y, phi):
    scene = Scene((frame(BASE, on_plane(x, y, phi)),), (box("body", (0.4, 0.2, 0.1), on_plane(0.1, 0.0)),))
    shown = flat(scene, "above")
    body = shown.outlines["body"]
    assert body.on_robot
    assert body.robots
    assert np.ptp(body.points, axis=0) == pytest.approx([0.4, 0.2])
    assert np.mean(body.points, axis=0) == pytest.approx([0.1, 0.0], abs=1e-6)
    assert (shown.x, shown.y) == (x, y)
    assert math.remainder(shown.phi - phi, math.tau) == pytest.approx(0.0, abs=1e-9)


@given(NUMBERS, NUMBERS, ANGLES)
def test_an_object_has_its_place_and_an_outline_that_turns_with_it(x, y, phi):
    table = box("table", (2.0, 1.0, 0.8), on_plane(x, y, phi), frame="map")
    shown = flat(Scene((frame(BASE, Pose3()),), (table,)), "above")
    assert shown.places["table"][:2] == (x, y)
    assert np.ptp(shown.outlines["table"].points, axis=0) == pytest.approx([2.0, 1.0])
    assert not shown.outlines["table"].robots


def test_from_behind_right_is_minus_y_and_up_is_z():
    pen = frame("pen", Pose3(0.5, -0.2, 1.4))
    shown = flat(Scene((pen,), (sphere("tip", 0.05, frame="pen"),), "pen"), "behind")
    assert (shown.x, shown.y, shown.phi) == (0.2, 1.4, None)
    assert np.mean(shown.outlines["tip"].points, axis=0) == pytest.approx([0.0, 0.0], abs=1e-9)
    assert shown.places["tip"] == (0.2, 1.4, 0.0)


def test_a_cylinder_is_round_from_above_and_a_rectangle_from_behind():
    pole = cylinder("pole", 0.1, 2.0, frame="map")
    above, behind = (
        flat(Scene((frame(BASE, Pose3()),), (pole,)), view).outlines["pole"] for view in ("above", "behind")
    )
    assert np.hypot(*np.transpose(above.points)) == pytest.approx(0.1, abs=1e-5)
    assert np.ptp(behind.points, axis=0) == pytest.approx([0.2, 2.0])


def test_lines_and_words_keep_their_points():
    scene = Scene((frame(BASE, Pose3()),), (line("edge", [(0, 0, 0), (1, 2, 3)]), text("name", "home", on_plane(1, 1))))
    shown = flat(scene, "above").outlines
    assert shown["edge"].points == ((0.0, 0.0), (1.0, 2.0))
    assert not shown["edge"].closed
    assert shown["name"].words == "home"


def test_a_shape_in_an_unknown_frame_is_left_out_and_a_scene_without_its_tracer_is_none():
    scene = Scene((frame(BASE, Pose3()),), (sphere("lost", 0.1, frame="nowhere"),))
    assert flat(scene, "above").outlines == {}
    assert flat(Scene((), (sphere("ball", 0.1),)), "above") is None
    assert on_map((frame("tool", Pose3(), "arm"),)).keys() == {"map"}
