"""Energy: the work of the drives in an episode, the models trained on it, and its weight in refinement."""

import math

import numpy as np
import pytest

from tailor.executive import domains
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.models.episodes.episodes import Episode, read_data_set, write_part
from tailor.models.episodes.examples import energy_examples
from tailor.models.episodes.manifest import write_manifest
from tailor.models.runtime import load_robot
from tailor.schemas.messages import JointState, Odometry
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.tools.evaluations.outcome import Task, Variant
from tailor.tools.evaluations.task_runs import run_one
from tailor.tools.lockstep import action_run
from tailor.tools.lockstep.samplers.drive_work import MASS_KG, joint_work_j, wheel_work_j


def truth(at_s: float, v: float, omega: float = 0.0) -> SoccerGroundTruth:
    return SoccerGroundTruth(round(at_s * 1e9), 0.0, 0.0, 0.0, v, omega, 0.0, 0.0, 0.0, 0.0)


def joints(at_s: float, efforts: tuple[float, ...], velocities: tuple[float, ...]) -> JointState:
    return JointState(round(at_s * 1e9), ("a", "b"), (0.0, 0.0), velocities, efforts)


def test_wheels_work_to_accelerate_and_recover_nothing_when_braking() -> None:
    assert wheel_work_j(truth(0.0, 0.0), truth(0.1, 0.5)) == pytest.approx(0.5 * MASS_KG * 0.25)
    assert wheel_work_j(truth(0.0, 0.5), truth(0.1, 0.0)) == 0.0
    assert wheel_work_j(truth(0.0, 0.0), truth(0.1, 0.0, 1.0)) > 0.1


def test_motors_work_where_torque_and_motion_agree() -> None:
    lifting = joints(0.0, (10.0, 0.0), (0.5, 0.0)), joints(0.1, (10.0, 0.0), (0.5, 0.0))
    assert joint_work_j(*lifting) == pytest.approx(0.5)
    lowering = joints(0.0, (10.0, 0.0), (-0.5, 0.0)), joints(0.1, (10.0, 0.0), (-0.5, 0.0))
    assert joint_work_j(*lowering) == 0.0


def test_states_without_speed_or_effort_give_no_work() -> None:
    assert math.isnan(wheel_work_j(truth(0.0, 0.0), joints(0.1, (1.0, 1.0), (1.0, 1.0))))
    assert math.isnan(joint_work_j(joints(0.0, (), (0.1, 0.1)), joints(0.1, (), (0.1, 0.1))))
    odom = [Odometry(k * 100_000_000, 0.0, 0.0, 0.0, 0.1 * k, 0.0) for k in range(2)]
    assert wheel_work_j(*odom) == pytest.approx(0.5 * MASS_KG * 0.01)


def test_an_episode_has_its_work_for_each_tick() -> None:
    domain = domains.load("soccer")
    arguments = np.array([0.0, 0.0, 0.0, 0.0, 1.5, 0.0, 0.0, 0.0])
    run = action_run.run_action(action_run.new_body(domain), domain, "goToPose", arguments, np.random.default_rng(3))
    assert run.work_j.shape == (len(run.ticks),)
    assert run.work_j[-1] == 0.0
    assert 0.5 * MASS_KG * 0.4**2 < run.work_j.sum() < 2 * MASS_KG * 0.9**2  # it got going, once


def test_work_survives_the_file_and_its_absence_is_kept(tmp_path) -> None:
    ticks = np.zeros((3, 2))
    measured = Episode(0, ticks[0], ticks, 0.3, True, "", work_j=np.array([1.0, 2.0, 0.0]))
    unmeasured = Episode(1, ticks[0], ticks, 0.3, True, "")
    arguments = [{"name": name, "unit": "m", "lower": -1.0, "upper": 1.0} for name in ("x", "y")]
    write_manifest(tmp_path, {"robot": "r", "action": "a", "arguments": arguments})
    write_part(tmp_path / "part-0.parquet", [measured, unmeasured], ["x", "y"])
    first, second = read_data_set(tmp_path).episodes
    assert first.work_j is not None
    assert first.work_j.tolist() == [1.0, 2.0, 0.0]
    assert second.work_j is None
    assert energy_examples([first, second], 2).targets.tolist() == [3.0, 2.0]  # remaining work


def test_every_action_that_ships_with_durations_ships_with_energies() -> None:
    for robot in ("agilo", "powercube"):
        durations, _ = load_robot(robot)
        actions = {name.split("/")[0] for name in durations}
        assert {f"{action}/{kind}" for action in actions for kind in ("duration", "energy")} <= set(durations)


def test_weight_of_energy_changes_how_the_arm_passes_its_waypoints() -> None:
    chosen = {}
    for weight in (0.0, 0.1):
        variant = Variant(f"joule {weight:g}", RefinementSettings(energy_weight=weight))
        outcome = run_one(Task("arm", "letter-T"), variant, 500)
        assert outcome.achieved
        chosen[weight] = [value for *_, value in outcome.free]
    assert chosen[0.0] != chosen[0.1]
