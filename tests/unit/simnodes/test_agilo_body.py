"""The simulated AGILO robot: same seed same bits, limits of its motors, sensors as declared, a ball that rolls."""

import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tailor.executive.domains.soccer import robot
from tailor.schemas.messages import Odometry, PoseEstimate
from tailor.schemas.messages.soccer import BallPercept
from tailor.schemas.topics import TOPICS
from tailor.simnodes.agilo import dimensions, firmware
from tailor.simnodes.agilo.body import AgiloBody
from tailor.simnodes.agilo.physical_parameters import PhysicalParameters
from tailor.simnodes.agilo.sensing import Sensing
from tailor.simnodes.body import STEP_NS

ROOT = Path(__file__).resolve().parents[3]
TICK_NS = 100_000_000
DRIVE = """
import numpy as np
from tailor.simnodes.agilo.body import AgiloBody
body = AgiloBody()
body.reset(np.random.default_rng(3), {"x": 1.0, "phi": 0.4, "v": 0.2, "ball_x": 1.5, "ball_y": 0.2})
readings = []
for i in range(60):
    body.command((0.6, 0.8 - 0.02 * i))
    readings += body.advance(100_000_000)
print(repr(readings[-6:]), body.ground_truth())
"""


def driven(command, ticks, start=None, body=None):
    body = body or AgiloBody()
    body.reset(np.random.default_rng(1), start or {})
    readings = []
    for _ in range(ticks):
        body.command(command)
        readings += body.advance(TICK_NS)
    return body, readings


def test_two_processes_give_equal_bits():
    def run():
        return subprocess.run(
            [sys.executable, "-c", DRIVE], capture_output=True, text=True, check=True, cwd=ROOT
        ).stdout

    first = run()
    assert first == run()
    assert "nan" not in first


def test_an_episode_does_not_depend_on_the_one_before():
    body, fresh = driven((0.5, 0.5), 20)
    first = body.ground_truth()
    driven((0.9, -1.0), 13, {"x": 2.0, "ball_x": 2.3, "ball_y": 0.0}, body)
    again, readings = driven((0.5, 0.5), 20, None, body)
    assert again.ground_truth() == first
    assert readings == fresh


def test_other_seed_gives_other_noise_but_the_same_physics():
    bodies = [AgiloBody(), AgiloBody()]
    readings = []
    for seed, body in enumerate(bodies):
        body.reset(np.random.default_rng(seed), {})
        body.command((0.5, 0.3))
        readings.append(body.advance(10 * TICK_NS))
    assert readings[0] != readings[1]
    assert bodies[0].ground_truth() == bodies[1].ground_truth()


def test_steps_of_any_length_lead_to_the_same_place():
    whole, parts = AgiloBody(), AgiloBody()
    for body in (whole, parts):
        body.reset(np.random.default_rng(1), {"v": 0.1})
        body.command((0.7, 0.5))
    readings = whole.advance(2 * TICK_NS)
    pieces = []
    for steps in (1, 2, 3, 7, 4, 3):
        pieces += parts.advance(steps * STEP_NS)
    assert whole.ground_truth() == parts.ground_truth()
    assert readings == pieces


def test_the_robot_moves_as_its_wheels_turn():
    truth = driven((0.5, 0.0), 40)[0].ground_truth()
    assert truth.v == pytest.approx(0.5, abs=0.01)
    assert truth.x == pytest.approx(0.5 * 4.0 - 0.25, abs=0.06)
    assert abs(truth.y) < 0.01
    turned = driven((0.0, 1.0), 20)[0].ground_truth()
    assert turned.omega == pytest.approx(1.0, abs=0.05)
    assert math.hypot(turned.x, turned.y) < 0.01


@pytest.mark.parametrize(
    ("set_point", "v", "omega"), [((9.0, 0.0), 0.9, 0.0), ((-9.0, 9.0), -0.9, 1.75), ((0.9, 1.75), 0.9, 1.75)]
)
def test_motor_board_keeps_within_the_limits_of_the_drive(set_point, v, omega):
    board = firmware.Firmware(0.30)
    board.accept(*set_point)
    for _ in range(200):
        got = board.tick()
    assert got == pytest.approx((v, omega))
    assert abs(got[0]) + 0.15 * abs(got[1]) <= firmware.RIM_MAX_MPS + 1e-9


def test_motor_board_slews_up_and_down_at_its_rates():
    board = firmware.Firmware(0.30)
    board.accept(0.9, 1.75)
    assert board.tick() == pytest.approx((0.5 * 0.02, 1.75 * 0.02))
    board.reset(0.5, 0.0)
    board.accept(0.0, 0.0)
    assert board.tick()[0] == pytest.approx(0.5 - 0.65 * 0.02)
    board.reset(0.005, 0.0)
    board.accept(-0.9, 0.0)
    assert board.tick()[0] == pytest.approx(0.005 - 0.65 * 0.02), "through zero it is braking first"


def test_free_ball_slows_down_as_declared():
    body = AgiloBody()
    body.reset(np.random.default_rng(0), {"ball_x": 2.0, "ball_y": 1.0, "ball_vx": 1.0})
    body.advance(10 * TICK_NS)
    assert body.ground_truth().ball_vx == pytest.approx(1.0 - robot.BALL_ROLLING_MPS2, abs=0.03)
    body.advance(15 * TICK_NS)
    assert body.ground_truth().ball_vx == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize(
    ("start", "command"),
    [
        ({"ball_x": 2.0, "ball_y": 1.0, "ball_vx": 1.0}, (0.0, 0.0)),
        ({"v": 0.5, "ball_x": 0.6, "ball_y": 0.03}, (0.5, 0.0)),
        ({"v": 0.8, "ball_x": 0.6, "ball_y": 0.08}, (0.8, 0.0)),
        ({"v": 0.5, "ball_x": 0.6, "ball_y": 0.20}, (0.5, 0.0)),
        ({"v": 0.36, "ball_x": robot.IN_RAIL_M, "ball_y": 0.0, "ball_vx": 0.36}, (0.36, 0.5)),
        ({"ball_x": 1.5, "ball_y": 0.02, "ball_vx": -2.0}, (0.0, 0.0)),
    ],
    ids=["rolls", "hit", "hit hard", "grazed by the rail's tip", "carried round", "caught"],
)
def test_ball_ends_where_ten_times_finer_steps_take_it(start, command):
    coarse = driven(command, 20, start)[0].ground_truth()
    finer = PhysicalParameters(timestep_s=PhysicalParameters().timestep_s / 10)
    fine = driven(command, 20, start, AgiloBody(finer))[0].ground_truth()
    assert coarse != fine
    assert math.hypot(coarse.ball_x - fine.ball_x, coarse.ball_y - fine.ball_y) < 0.03
    assert math.hypot(coarse.x - fine.x, coarse.y - fine.y) < 0.02


@pytest.mark.parametrize(("omega", "held"), [(0.6, True), (0.95, False)])
def test_rail_holds_the_ball_in_gentle_turns_only(omega, held):
    start = {"v": 0.36, "ball_x": robot.IN_RAIL_M, "ball_y": 0.0, "ball_vx": 0.36}
    body = AgiloBody()
    body.reset(np.random.default_rng(0), start)
    for tick in range(80):
        body.command((0.36, min(omega, 0.1 * tick)))
        body.advance(TICK_NS)
    t = body.ground_truth()
    distance = math.hypot(t.ball_x - t.x, t.ball_y - t.y)
    assert (abs(distance - robot.IN_RAIL_M) < 0.02) is held


def test_the_executive_and_the_body_have_the_same_dimensions():
    assert pytest.approx(robot.IN_RAIL_M) == dimensions.BALL_IN_RAIL_M
    assert (firmware.V_MAX_MPS, firmware.OMEGA_MAX_RADPS) == (robot.V_MAX_MPS, robot.OMEGA_MAX_RADPS)


def test_readings_fall_due_at_the_rates_of_the_topics_in_order():
    _, readings = driven((0.3, 0.0), 400, {"ball_x": 60.0, "ball_y": 0.0}, AgiloBody(sensing=Sensing(pose_dropout=0.0)))
    assert [r.time_ns for r in readings] == sorted(r.time_ns for r in readings)
    for topic in ("odom", "pose", "truth"):
        assert sum(r.topic == topic for r in readings) == pytest.approx(40 * TOPICS[topic].rate_hz, abs=1)
    assert all(r.message.stamp_ns <= r.time_ns for r in readings)


def test_camera_delay_makes_percepts_late_but_keeps_their_stamps():
    _, readings = driven(
        (0.0, 0.0), 10, {"ball_x": 1.0, "ball_y": 0.0}, AgiloBody(sensing=Sensing(camera_delay_ns=60_000_000))
    )
    late = [r for r in readings if isinstance(r.message, PoseEstimate | BallPercept)]
    assert late
    assert {r.time_ns - r.message.stamp_ns for r in late} == {60_000_000}


def test_pose_noise_has_its_declared_size_and_is_correlated():
    body = AgiloBody(sensing=Sensing(pose_dropout=0.0))
    body.reset(np.random.default_rng(5), {})
    poses = [r.message for r in body.advance(3_000 * TICK_NS // 5) if r.topic == "pose"]
    x = np.array([p.x for p in poses])
    assert x.std() == pytest.approx(0.045, rel=0.25)
    assert poses[0].var_x == pytest.approx(0.045**2)
    assert np.corrcoef(x[:-1], x[1:])[0, 1] == pytest.approx(math.exp(-0.08 / 0.6), abs=0.05)


@pytest.mark.parametrize(
    ("ball", "visible"), [((1.0, 0.0), True), ((-1.0, 0.0), False), ((1.0, 1.5), False), ((9.0, 0.0), False)]
)
def test_the_ball_is_measured_only_in_view(ball, visible):
    _, readings = driven((0.0, 0.0), 20, {"ball_x": ball[0], "ball_y": ball[1]})
    percepts = [r.message for r in readings if r.topic == "ball"]
    assert bool(percepts) is visible
    if visible:
        assert np.mean([p.x for p in percepts]) == pytest.approx(1.0, abs=0.06)


def test_odometry_adds_up_to_the_true_pose():
    body, readings = driven((0.5, 0.3), 60)
    last = [r.message for r in readings if isinstance(r.message, Odometry)][-1]
    truth = body.ground_truth()
    assert math.hypot(last.x - truth.x, last.y - truth.y) < 0.15
    assert last.v == pytest.approx(truth.v, abs=0.05)


def test_placing_robot_or_ball_leaves_the_other_alone():
    body, _ = driven((0.4, 0.0), 20, {"ball_x": 3.0, "ball_y": 0.0})
    before = body.ground_truth()
    body.place({"ball_vx": 0.0, "ball_vy": 1.0})
    after = body.ground_truth()
    assert (after.ball_x, after.ball_vy) == (before.ball_x, 1.0)
    assert (after.x, after.v) == (before.x, before.v)
    body.place({"x": -1.0})
    assert (body.ground_truth().x, body.ground_truth().y) == (-1.0, before.y)
