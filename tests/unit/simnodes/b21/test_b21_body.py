"""The B21's body: repeatable, within its limits, with sensors as declared."""

import hashlib
import math
import subprocess
import sys
from collections import Counter

import numpy as np
import pytest

from tailor.robots.kitchen_topics import TOPICS as OWN_TOPICS
from tailor.schemas.kitchen.furniture import kitchen
from tailor.schemas.kitchen.kinematics import ARM, HALF_VIEW_RAD, HOME, JOINTS, OMEGA_MAX_RADPS, V_MAX_MPS, tool_pose
from tailor.schemas.packages.pose3 import on_plane
from tailor.schemas.topics import TOPICS
from tailor.simnodes.b21.body import B21Body
from tailor.simnodes.b21.profiles import body as of_profile
from tests.support.cpu_time import standard_cpu_s
from tests.support.kitchen.b21_moves import cups_on_tables, fetch, standing_at

STILL = (0.0,) * 6
SECOND_NS = 1_000_000_000


def made(profile="paper", seed=0, **start):
    body = of_profile(profile)
    body.reset(np.random.default_rng(seed), start)
    return body


def drive(body, v, omega, seconds=1.0):
    body.command((v, omega, *STILL, 0.0))
    return body.advance(round(seconds * 100) * 10_000_000)


def fingerprint(seed):
    body = made("real", seed, **cups_on_tables("cup1", "cup2"), **standing_at("table1"))
    readings = fetch(body, "cup1")
    body.place({"cup1_vx": 1.0, "cup2_x": 0.5, "cup2_y": 0.5})
    return hashlib.sha256(repr(readings + drive(body, -0.4, 0.8)).encode()).hexdigest()


def test_same_seed_and_commands_give_the_same_readings_in_two_processes_and_after_a_reset():
    pytest.importorskip("pybullet")
    code = "from tests.unit.simnodes.b21.test_b21_body import fingerprint; print(fingerprint(8), fingerprint(7))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr == ""  # nor does PyBullet print anything
    here = [fingerprint(8), fingerprint(7)]
    assert done.stdout.split() == here
    assert here[0] != here[1]


def test_a_reset_body_is_a_new_one():
    used = made(seed=1, **cups_on_tables("cup1"), **standing_at("table1"))
    fetch(used, "cup1")
    used.place({"table2_x": 0.9, "fumble": 2.0})
    used.reset(np.random.default_rng(5), {})
    assert drive(used, 0.3, 0.2) == drive(made(seed=5), 0.3, 0.2)


def test_advancing_in_pieces_is_advancing_at_once():
    once, pieces = made("real"), made("real")
    for body in (once, pieces):
        body.command((0.4, -0.3, *STILL, 0.1))
    assert [reading for _ in range(20) for reading in pieces.advance(SECOND_NS // 20)] == once.advance(SECOND_NS)


def test_the_robot_is_that_of_the_kinematics():
    bullet, rng = made()._bullet, np.random.default_rng(1)
    for _ in range(10):
        angles = [rng.uniform(joint.lower, joint.upper) for joint in ARM]
        body = made(x=0.4, y=0.2, phi=1.0, **dict(zip(JOINTS, angles, strict=True)))
        link = bullet.getLinkState(body._robot.body, body._robot.hand, physicsClientId=body.client)
        expected = on_plane(0.4, 0.2, 1.0).then(tool_pose(angles))
        finger = bullet.multiplyTransforms(link[4], link[5], (0.12, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
        assert finger[0] == pytest.approx((expected.x, expected.y, expected.z), abs=1e-6)
        same = np.dot(finger[1], (expected.qx, expected.qy, expected.qz, expected.qw))
        assert abs(same) == pytest.approx(1.0, abs=1e-6)


def test_the_base_ramps_up_to_its_limits_and_no_further():
    body = made(x=-2.0, y=0.5, phi=0.0)
    drive(body, 9.0, 0.0, 0.5)
    assert body.ground_truth().v == pytest.approx(0.25, abs=0.01)
    drive(body, 9.0, 0.0, 1.5)
    assert body.ground_truth().v == pytest.approx(V_MAX_MPS, abs=1e-3)
    drive(body, 0.0, 9.0, 2.0)
    truth = body.ground_truth()
    assert (truth.v, truth.omega) == pytest.approx((0.0, OMEGA_MAX_RADPS), abs=1e-3)


def test_a_turning_base_drives_a_circle():
    body = made(x=-0.5, y=0.0, phi=0.0, v=0.3, omega=0.5)
    drive(body, 0.3, 0.5, math.tau / 0.5)
    truth = body.ground_truth()
    assert (truth.x, truth.y) == pytest.approx((-0.5, 0.0), abs=0.01)


def test_joints_stop_at_their_range_and_hold_the_arm():
    body = made()
    body.command((0.0, 0.0, 9.0, *STILL[1:], 0.0))
    body.advance(3 * SECOND_NS)
    assert body.ground_truth().angles[0] == pytest.approx(ARM[0].upper, abs=1e-3)
    assert body.ground_truth().angles[1:] == pytest.approx(HOME[1:], abs=1e-3)


def test_touched_furniture_is_reported_and_stops_the_base():
    body = made(**standing_at("table3", 0.5))
    touched = [r.message.touched for r in drive(body, 0.3, 0.0, 3.0) if r.topic == "kitchen_truth"]
    assert set(sum(touched, ())) == {"table3"}
    assert abs(body.ground_truth().v) < 0.02


def test_sensors_have_the_rates_of_their_topics():
    counts = Counter(reading.topic for reading in drive(made(**cups_on_tables("cup1")), 0.1, 0.1, 4.0))
    rows = {**OWN_TOPICS, **{name: TOPICS[name] for name in ("odom", "pose", "joint_states")}}
    assert counts == {name: round(4 * row.rate_hz) for name, row in rows.items() if row.source != "executive"}


def test_the_camera_sees_only_what_is_in_front_of_it():
    body = made(x=0.0, y=0.5, phi=0.0, **cups_on_tables("cup1"))
    percepts = [each for r in drive(body, 0.0, 0.0, 3.0) if r.topic == "objects" for each in r.message.objects]
    assert {each.name for each in percepts} == {"table2", "stool"}
    assert all(abs(math.atan2(each.y, each.x)) < HALF_VIEW_RAD + 0.05 for each in percepts)
    seen = sum(each.name == "table2" for each in percepts)
    assert 20 <= seen <= 30  # a few are lost


def test_the_robot_of_the_paper_knows_itself_exactly_and_the_real_one_does_not():
    exact, noisy = made(x=0.5, phi=0.3), made("real", x=0.5, phi=0.3)
    poses = [[r.message for r in drive(body, 0.0, 0.0) if r.topic == "pose"] for body in (exact, noisy)]
    assert all((pose.x, pose.phi) == pytest.approx((0.5, 0.3), abs=1e-6) for pose in poses[0])
    assert max(abs(pose.x - 0.5) for pose in poses[1]) > 0.002


def test_start_values_displace_tables_and_stool():
    truth = made(table1_x=-2.3, table1_phi=0.1, stool_y=0.4).ground_truth()
    places = {each.name: (each.x, each.y, each.phi) for each in truth.objects}
    assert places["table1"] == (-2.3, kitchen().tables["table1"][1], 0.1)
    assert places["stool"] == (kitchen().stool.place[0], 0.4, 0.0)


@pytest.mark.slow
def test_the_body_is_40_times_faster_than_real_time():
    body = made(**cups_on_tables("cup1", "cup2", "cup3"))
    drive(body, 0.1, 0.1)
    assert standard_cpu_s(lambda: drive(body, 0.0, 0.1, 20.0)) < 20.0 / 40


def test_many_bodies_may_be_made():
    for _ in range(10):
        B21Body().reset(np.random.default_rng(0), {})
