"""What the code of a robot's package raises in the midst of a run ends the process with one line, and no restart."""

import os
import subprocess
import sys

import pytest

from tailor.runtime.processes.child import tailor
from tailor.schemas.errors import UsageError
from tailor.schemas.packages.spec import DomainSpec
from tailor.tools.cli.package_run import blamed_on_running_package
from tailor.tools.lockstep import blame
from tailor.tools.new_robot.templates import write_robot
from tests.support.bus_system import bus_system
from tests.support.patience import PATIENCE_S

CODE = """
import json

def breaks(text):
    return lost(text)

def lost(text):
    return json.loads(text)

def calls(function):
    return function()
"""


@pytest.fixture
def ours(tmp_path, monkeypatch):
    (tmp_path / "lorry").mkdir()
    (tmp_path / "lorry" / "__init__.py").touch()
    (tmp_path / "lorry" / "wheels.py").write_text(CODE)
    monkeypatch.syspath_prepend(str(tmp_path))
    yield DomainSpec("haul", "lorry", "lorry.domain:make", package="lorry"), __import__("lorry.wheels").wheels
    for name in [name for name in sys.modules if name.startswith("lorry")]:
        del sys.modules[name]


def test_an_error_names_package_function_and_line_and_its_traceback_begins_in_the_package(ours, capsys):
    spec, wheels = ours
    with pytest.raises(UsageError) as raised, blamed_on_running_package(spec):
        wheels.breaks("{\x1b")
    assert str(raised.value) == (
        "the package of haul raised JSONDecodeError: Expecting property name enclosed in double quotes: "
        f"line 1 column 2 (char 1) (in lost, {wheels.__file__}, line 8); the robot is stopped"
    )
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "Traceback (most recent call last):"
    assert lines[1] == f'  File "{wheels.__file__}", line 5, in breaks'
    assert lines[-1].startswith("json.decoder.JSONDecodeError: ")


def test_a_text_of_several_lines_stays_one_line(ours, capsys):
    spec, wheels = ours

    def fails():
        raise ValueError("no wheel\nleft \x1b[1m")

    with (
        pytest.raises(UsageError, match=r"raised ValueError: no wheel left .* \(in calls, "),
        blamed_on_running_package(spec),
    ):
        wheels.calls(fails)
    assert "\x1b" not in capsys.readouterr().err


def test_a_package_that_ends_the_process_is_named(ours, capsys):
    spec, wheels = ours
    with pytest.raises(UsageError, match=r"raised SystemExit: 3 \(in calls, "), blamed_on_running_package(spec):
        wheels.calls(lambda: sys.exit(3))


def test_in_lockstep_an_error_outside_of_the_package_keeps_its_traceback(ours, monkeypatch, capsys):
    spec, wheels = ours
    monkeypatch.setattr(blame, "spec_of", lambda _: spec)
    with (
        pytest.raises(
            UsageError, match=r"^the package of haul cannot be run: KeyError: 'ours' \(test_package_run.py, "
        ),
        blame.blamed_on_run("haul"),
    ):
        raise KeyError("ours")
    lines = capsys.readouterr().err.splitlines()
    assert (lines[0], lines[-1]) == ("Traceback (most recent call last):", "KeyError: 'ours'")
    with (
        pytest.raises(
            UsageError, match=r"^the package of haul cannot be run: JSONDecodeError: .* \(wheels.py, line 8\)"
        ),
        blame.blamed_on_run("haul"),
    ):
        wheels.breaks("{")
    assert capsys.readouterr().err == "", "the package's own mistake is one line"


def test_errors_of_our_own_and_of_packages_that_ship_stay_as_they_are(ours, capsys):
    spec, wheels = ours
    with pytest.raises(KeyError), blamed_on_running_package(spec):
        raise KeyError("ours")
    shipped = DomainSpec("soccer", "agilo", "tailor.executive.domains.soccer.domain:make", package="tailor.robots")
    with pytest.raises(ValueError, match="Expecting value"), blamed_on_running_package(shipped):
        wheels.breaks("")
    with pytest.raises(UsageError, match=r"^expected$"), blamed_on_running_package(spec):
        raise UsageError("expected")
    assert capsys.readouterr().err == ""


def test_a_simulated_body_that_raises_in_motion_ends_its_process_with_a_line_and_no_restart(tmp_path):
    folder = write_robot("cart", "wheeled", tmp_path)
    body = folder / "cart" / "body.py"
    text = body.read_text()
    assert "    def _drive(self) -> None:\n" in text
    body.write_text(
        text.replace("    def _drive(self) -> None:\n", "    def _drive(self) -> None:\n        self.lost()\n")
    )
    info = folder / "cart-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: cart\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[tailor.domains]\ncart = cart:SPEC\n")
    paths = [str(folder), *os.environ.get("PYTHONPATH", "").split(os.pathsep)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))}
    with bus_system() as (_, endpoint, _):
        words = tailor("sim", "cart", "--connect", endpoint)
        done = subprocess.run(words, capture_output=True, text=True, timeout=PATIENCE_S, env=environment)
    assert done.returncode == 2, done.stderr
    last = done.stderr.splitlines()[-1]
    assert last.startswith(
        "tailor sim: the package of cart raised AttributeError: 'Body' object has no attribute 'lost'"
    )
    assert f"(in _drive, {body}, line " in last
