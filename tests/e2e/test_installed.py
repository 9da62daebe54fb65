"""The installed wheel holds one import name and works in a folder whose own modules have our folders' names.

Nothing is downloaded: the fresh environment sees the third-party packages of the test environment through a .pth file.
"""

import subprocess
import tarfile
import zipfile
from pathlib import Path

import pytest

import tailor
from tailor.tools.launch.hosting import free_endpoint
from tests.support.bus_system import ROOT
from tests.support.robots.fresh_environment import LINKS, Environment, built, copied_source

DATA_KINDS = {
    f".{kind}"
    for kind in ["template", "msg", "pddl", "toml", "xml", "urdf", "onnx", "json", "html", "js", "css", "typed"]
}
PDDL = ROOT / "tests" / "data" / "pddl" / "own"
HOSTILE = 'raise SystemExit("a module of the working folder was imported")\n'

pytestmark = pytest.mark.xdist_group("systems")  # one worker: the wheel is built once


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    """A copy of the sources, so that the checkout gets no build folder."""
    return copied_source(tmp_path_factory.mktemp("source"))


@pytest.fixture(scope="module")
def wheel(source, tmp_path_factory):
    """The wheel, as `pip install .` builds it."""
    return built("build_wheel", source, tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """The `tailor` command of a fresh environment that has the wheel."""
    return Environment.made(tmp_path_factory.mktemp("environment"), wheel).program("tailor")


@pytest.fixture
def hostile_folder(tmp_path):
    """A foreign project: its modules have the names of our folders, of our package and of a library, and raise."""
    for name in ("models.py", "runtime.py", "tailor.py", "numpy.py"):
        (tmp_path / name).write_text(HOSTILE)
    (tmp_path / "tools").mkdir()
    (tmp_path / "tools" / "__init__.py").write_text(HOSTILE)
    return tmp_path


@pytest.fixture
def call(installed, hostile_folder):
    """Calls an installed command in the hostile folder and returns the completed process."""
    environment = Environment(installed.parents[1])

    def completed(*arguments):
        return environment.call(hostile_folder, "tailor", *arguments)

    return completed


@pytest.fixture
def run(call):
    """Calls an installed command that must succeed and returns its output."""

    def output(*arguments):
        done = call(*arguments)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    return output


def test_the_wheel_has_one_top_level_name(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    assert {name.split("/")[0] for name in names} == {"tailor", f"tailor-{tailor.__version__}.dist-info"}


def test_the_wheel_finds_its_robots_by_their_entry_points(call):
    assert "no robot 'hal', expected one of: powercube, b21, agilo" in call("sim", "hal").stderr


def test_the_wheel_holds_every_module_and_every_data_file(wheel):
    names = set(zipfile.ZipFile(wheel).namelist())
    files = [
        p.relative_to(ROOT) for name in LINKS for p in (ROOT / name).rglob("*") if p.suffix in {".py", *DATA_KINDS}
    ]
    assert {f"tailor/{p.as_posix()}" for p in files} | {
        "tailor/__init__.py",
        "tailor/planning.py",
        "tailor/py.typed",
    } <= names


def test_the_checkout_has_no_data_file_of_another_kind():
    """A new kind needs a line in [tool.setuptools.package-data]."""
    listed = subprocess.run(["git", "ls-files", *LINKS], cwd=ROOT, capture_output=True, text=True)
    if listed.returncode != 0:
        pytest.skip("not a git checkout")
    assert {Path(name).suffix for name in listed.stdout.split()} <= {".py", *DATA_KINDS}


def test_a_source_distribution_builds_the_same_wheel(source, wheel, tmp_path):
    """The links of src/tailor are stored as the folders that they lead to."""
    archive = built("build_sdist", source, tmp_path)
    with tarfile.open(archive) as tar:
        tar.extractall(tmp_path, filter="data")
    again = built("build_wheel", tmp_path / archive.name.removesuffix(".tar.gz"), tmp_path)
    assert sorted(zipfile.ZipFile(again).namelist()) == sorted(zipfile.ZipFile(wheel).namelist())


def test_the_command_imports_the_installed_package(installed):
    python = installed.with_name("python")
    code = "import tailor; print(tailor.__file__)"
    printed = subprocess.run([python, "-P", "-c", code], capture_output=True, text=True, check=True, env={}).stdout
    assert Path(printed.strip()).is_relative_to(installed.parents[1])


def test_version_is_printed(run):
    assert run("--version") == f"tailor {tailor.__version__}\n"


def test_plan_finds_a_plan(run):
    assert run("plan", PDDL / "kitchen-domain.pddl", PDDL / "kitchen-s1.pddl")


@pytest.mark.promise("P56")
def test_a_system_starts_records_verifies_and_is_drawn(run, hostile_folder):
    run("up", "arm", "--scenario", "letter-I", "--once", "--record", "run.mcap", "--connect", free_endpoint())
    run("verify", "run.mcap")
    run("view", "run.mcap", "-o", "run.html")
    assert "<html" in (hostile_folder / "run.html").read_text()


def test_training_never_writes_into_the_installation(call, installed):
    files = sorted((p, p.stat().st_mtime_ns) for p in installed.parents[1].rglob("zoo/**/*"))
    done = call("train", "agilo")
    assert done.returncode == 2
    assert "--zoo" in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert files
    assert files == sorted((p, p.stat().st_mtime_ns) for p in installed.parents[1].rglob("zoo/**/*"))
