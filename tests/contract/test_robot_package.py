"""A robot in a package outside Tailor: the commands know it, and no file of ours names it."""

import json
import shutil
from pathlib import Path

import pytest

from tailor.schemas.installed import file, spec_of
from tests.support.robots.robot_package import install, run_with

SPEC = """
from tailor.schemas.packages.spec import DomainSpec

SPEC = DomainSpec(
    "courier",
    "pedelec",
    domain="courier_robot.domain:make",
    body="tailor.simnodes.agilo.body:AgiloBody",
    sampler="tailor.tools.lockstep.samplers.soccer:SoccerSampler",
    draw="tailor.executive.domains.soccer.scenario_sampling:sample_scenario",
)
"""
DOMAIN = """
from dataclasses import replace
from tailor.executive.domains import soccer

def make():
    return replace(soccer.make(), name="courier", robot="pedelec")
"""
POINTS = {"courier": "courier_robot:SPEC"}


@pytest.fixture
def site(tmp_path):
    """A folder of the path with the package: a robot like AGILO, under names of its own."""
    driver = (
        file(spec_of("soccer"), "driver").read_text(encoding="utf-8").replace('robot = "agilo"', 'robot = "pedelec"')
    )
    install(tmp_path, {"__init__.py": SPEC, "domain.py": DOMAIN, "driver.toml": driver}, POINTS)
    shutil.copytree(Path(str(file(spec_of("soccer"), "scenarios"))), tmp_path / "courier_robot" / "scenarios")
    return tmp_path


def tailor(site, *arguments):
    return run_with(site, "-m", "tailor.tools.main", *map(str, arguments))


def test_its_episodes_are_gathered(site, tmp_path):
    done = tailor(
        site, "gather", "pedelec", "goToPose", "--episodes", 2, "--jobs", 1, "--out", tmp_path / "data", "--json"
    )
    assert done.returncode == 0, done.stderr
    manifest = json.loads((tmp_path / "data" / "goToPose" / "manifest.json").read_text())
    assert (manifest["robot"], manifest["action"]) == ("pedelec", "goToPose")


def test_it_is_refused_before_anything_starts_while_it_has_no_models(site):
    done = tailor(site, "up", "courier", "--once")
    assert done.returncode == 2
    assert len(done.stderr.strip().split("\n")) == 1
    assert "no action models for robot 'pedelec' in" in done.stderr
    assert "courier_robot/models" in done.stderr


def test_all_faults_of_its_parts_stand_in_one_line(site):
    folder = site / "courier_robot"
    text = (folder / "driver.toml").read_text()
    (folder / "driver.toml").write_text(
        text.replace("rate_hz = 50", "rate_hz = 2").replace("upper = 0.9", "upper = 0.5")
    )
    (folder / "domain.py").write_text(DOMAIN.replace('robot="pedelec"', 'robot="pedelec", required=("odom", "lidar")'))
    done = tailor(site, "up", "courier")
    assert done.returncode == 2
    assert len(done.stderr.strip().split("\n")) == 1
    for fault in (
        "courier_robot.domain:make: required: 'lidar' is none of sensors",
        "driver.toml: v ranges from -0.9 to 0.9 m/s, the driver's limits are -0.9 and 0.5",
        "driver.toml: odom comes at 2 Hz, expected at least 4 Hz: it is stale after 0.5 s",
    ):
        assert fault in done.stderr


def test_a_package_that_raises_hinders_no_other_robot(site):
    (site / "courier_robot" / "__init__.py").write_text("raise SystemError('broken')\n")
    assert "courier_robot:SPEC: cannot be loaded: SystemError: broken" in tailor(site, "up", "courier").stderr
    done = tailor(site, "sim", "hal")
    assert "no robot 'hal', expected one of: powercube, b21, agilo" in done.stderr


def test_it_is_an_environment_of_gymnasium_without_any_model(site):
    code = (
        "import gymnasium; from gymnasium.utils.env_checker import check_env; import tailor.tools.gym\n"
        "env = gymnasium.make('tailor-action/courier-v0'); check_env(env.unwrapped, skip_render_check=True)\n"
        "print('tailor/courier-v0' in gymnasium.registry)"
    )
    done = run_with(site, "-c", code)
    assert (done.returncode, done.stdout) == (0, "True\n"), done.stderr
