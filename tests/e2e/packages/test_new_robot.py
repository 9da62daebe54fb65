"""A new robot's package runs with no line edited, in a fresh environment that has the wheel; so does a foreign one."""

import shutil
from pathlib import Path

import pytest

from tailor.tools.launch.hosting import free_endpoint
from tailor.tools.new_robot.templates import kinds
from tests.support.bus_system import ROOT

PORTER = ROOT / "tests" / "support" / "robots" / "porter"
FORKLIFT = ROOT / "tests" / "support" / "robots" / "forklift"
EPISODES = 120  # few, for time's sake: enough to learn from
FAST = ("--learner", "m5")  # a minute less than the default one, which the tutorial trains with

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("systems")]


@pytest.fixture
def run(environment, tmp_path):
    """Calls a program of the environment that must succeed, and returns its output."""

    def output(cwd, program, *arguments):
        share = {"XDG_DATA_HOME": str(tmp_path / "share")}
        done = environment.call(cwd, program, *arguments, timeout_s=1200, **share)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout + done.stderr

    return output


def from_episodes_to_a_verified_run(run, folder, domain, robot):
    run(folder, "tailor", "gather", robot, "--episodes", EPISODES, "--jobs", 2)
    run(folder, "tailor", "train", robot, *FAST)
    run(folder, "tailor", "up", domain, "--once", "--record", "run.mcap", "--connect", free_endpoint())
    assert "equal" in run(folder, "tailor", "verify", "run.mcap")
    run(folder, "tailor", "view", "run.mcap", "-o", "run.html")
    assert "<html" in (folder / "run.html").read_text()


@pytest.mark.parametrize("kind", kinds())
def test_a_new_robot_runs_with_no_line_edited(kind, environment, run, tmp_path):
    name = f"fresh-{kind}"
    run(tmp_path, "tailor", "new", "robot", name, "--kind", kind)
    folder = tmp_path / name
    environment.install("--no-build-isolation", "--editable", folder)
    from_episodes_to_a_verified_run(run, folder, name, name)
    assert (folder / f"fresh_{kind}" / "models" / name).is_dir()
    if kind == "wheeled":
        script = ROOT / "tests" / "e2e" / "packages" / "drive_plain_robot.py"
        assert "\nachieved" in f"\n{run(folder, 'python', script, name, ROOT)}"
    assert "passed" in run(folder, "pytest")


@pytest.mark.parametrize("editable", [True, False], ids=["editable", "installed"])
def test_a_package_with_messages_axes_and_features_of_its_own_runs(editable, environment, run, tmp_path):
    folder = Path(shutil.copytree(FORKLIFT, tmp_path / "forklift"))
    environment.install("--no-build-isolation", *(["--editable"] if editable else ["--force-reinstall"]), folder)
    work = folder if editable else tmp_path
    from_episodes_to_a_verified_run(run, work, "warehouse", "truck-7")
    assert (tmp_path / "share" / "tailor" / "models" / "truck-7").is_dir() is not editable
    assert "truck_msgs/msg/TruckCommand" in run(work, "tailor", "info", "run.mcap")
    if editable:
        assert "passed" in run(folder, "pytest")


def test_a_robot_with_two_outlets_runs_and_one_guard_stops_both(environment, run, tmp_path):
    folder = Path(shutil.copytree(PORTER, tmp_path / "porter"))
    environment.install("--no-build-isolation", "--editable", folder)
    from_episodes_to_a_verified_run(run, folder, "depot", "porter-3")
    told = run(folder, "tailor", "info", "run.mcap")
    assert "porter_msgs/msg/RailCommand" in told
    assert "porter_msgs/msg/GripCommand" in told
    stopped = run(folder, "python", ROOT / "tests" / "e2e" / "packages" / "silence_one_outlet.py", free_endpoint())
    assert "stopped" in stopped.splitlines()
