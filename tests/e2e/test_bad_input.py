"""Errors of users: one clear line, exit code 2, and no process started."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess

import pytest

from tailor.models.runtime import ZOO
from tailor.runtime.processes.child import tailor
from tailor.tools.main import main
from tests.support.bus_system import ROOT, free_endpoint
from tests.support.patience import PATIENCE_S


def refused(*arguments):
    """The one line on stderr."""
    done = subprocess.run(tailor(*map(str, arguments)), capture_output=True, text=True, timeout=PATIENCE_S, cwd=ROOT)
    return line_of(done.returncode, done.stdout, done.stderr)


def refused_here(capsys, *arguments):
    """The same of a command in this process, which takes a tenth of the time."""
    code = main(list(map(str, arguments)))
    return line_of(code, *capsys.readouterr())


def line_of(code, output, errors):
    assert code == 2, errors
    assert output == ""
    lines = errors.strip().splitlines()
    assert len(lines) == 1, errors
    return lines[0]


MISTAKES = [
    (("up", "chess"), "no domain 'chess', expected one of: "),
    (("up", "agilo"), "no domain 'agilo', expected one of: arm, kitchen, soccer (agilo is the robot of soccer)"),
    (("up", "soccer", "--scenario", "nope"), "no scenario 'nope' in soccer, expected one of: approach-dribble"),
    (("up", "soccer", "--seed", "-1"), "--seed is -1, expected at least 0"),
    (("up", "soccer", "--horizon", "0"), "--horizon is 0, expected at least 1"),
    (("up", "soccer", "--seed", "9" * 20), f"--seed is {'9' * 20}, expected a number of at most 64 bits"),
    (("up", "soccer", "--planner", "no-such-vhpop -g"), "there is no program 'no-such-vhpop'"),
    (
        ("executive", "soccer", "--planner", "'vhpop"),
        "planner command ''vhpop': cannot be started: No closing quot",
    ),
    (("sim", "hal"), "no robot 'hal', expected one of: powercube, b21, agilo"),
    (("sim", "soccer"), "expected one of: powercube, b21, agilo (agilo is the robot of soccer)"),
    (("driver", "nowhere:Rover"), "nowhere:Rover: No module named 'nowhere', expected package.module:Class"),
    (("check-driver", "hal"), "no robot 'hal', expected one of: "),
    (("check-driver", "agilo", "--speed", "0.9"), "--speed is 0.9, expected more than 0 and at most 0.3"),
    (("check-driver", "agilo", "--clause", "dances"), "--clause dances: expected one of: reports_its_state"),
    (("driver", "nowhere.toml"), "nowhere.toml: No such file or directory, expected the description of a robot"),
    (("arm", ""), "robot '': expected a name, e.g. agilo"),
    (("arm", "agilo#"), "robot 'agilo#': expected a name"),
    (("arm", "*"), "robot '*': expected a name"),
    (("arm", "agilo", "--off", "--reset"), "--off disarms, which releases no emergency stop"),
    (("executive", "soccer", "--goal", "(atbal pos3)"), "atbal"),
    (("executive", "soccer", "--goal", "(atball pos3"), ":1:"),
    (("executive", "soccer", "--goal", "( and )"), "--goal ( and ): has no condition, expected one, or --wait"),
    (("goal", "--cancel", "(atball pos3)"), "--cancel: expected without a goal"),
    (("goal", "(atball pos3)"), "no router responds"),
    (("status", "--json", "--seconds", "0"), "--seconds is 0, expected 0.2 to 3600"),
    (("status", "--seconds", "nan"), "--seconds is 'nan', expected a number, at least 0"),
    (("status", "--connect", "7447"), "expected PROTOCOL/HOST:PORT"),
    (("frobnicate",), "unknown command 'frobnicate'"),
    (("verify", "nowhere.mcap"), "nowhere.mcap"),
    (("verify", "nowhere.mcap", "-o", "x.mcap", "--without-proofs"), "--output writes all outputs"),
    (("plan", "domain.pddl"), "domain.pddl: cannot be read: No such file or directory"),
    (
        ("plan", "domain.pddl", "problem.pddl", "-T", "nan"),
        "--time-limit: expected a number of minutes of at least 0, found 'nan'",
    ),
    (("plan", "domain\x1b[31m\n.pddl", "problem.pddl"), "domain\\x1b[31m\\n.pddl: cannot be read"),
    (("replay", "run.mcap", "--start", "nan"), "--start is nan, expected 0 to 1e+09"),
    (("replay", "run.mcap", "--clock", "-1"), "--clock is -1, expected 0 to 10000"),
    (("record", "--max-size", "nan"), "--max-size is nan, expected 0 to 1e+09"),
    (("cut", "run.mcap", "--from", "inf"), "--from is inf, expected seconds from 0 on"),
    (("compare", "a.mcap", "b.mcap", "--plot", "c.xyz"), "--plot c.xyz: expected a name that ends in .png"),
    (("view", "a.mcap", "-o", "a.mcap"), "--output a.mcap: expected a name that ends in .html or .htm"),
    (("scene", "--layout", "soccer", "-o", "a.mcap"), "--output a.mcap: expected a name that ends in .json"),
    (
        ("picture", "a.mcap", "-o", "p.txt"),
        "--output p.txt: expected a name that ends in .png, .gif, .webp or .apng",
    ),
    (("picture", "a.mcap", "-o", ""), "--output .: expected a name"),
    (("why", "a.mcap", "-o", "p.txt"), "--output p.txt: expected a name that ends in .png or .html"),
    (("check-driver", "agilo", "--no-fit", "--top-speed"), "--top-speed: of the comparison that --no-fit leaves"),
    (("check-driver", "agilo", "--report", "README.md/p.md"), "--report README.md/p.md: "),
    (("check-driver", "agilo", "--report", "p.txt"), "--report p.txt: expected a name that ends in .md"),
    (("sim", "agilo", "--leave", "zz"), "--leave zz: expected 32 hex digits"),
    (("driver", "nowhere.toml", "--leave", "zz"), "--leave zz: expected 32 hex digits"),
    (("up", "arm", "--letters", "A", "--scenario", "letter-T"), "--letters: expected without --scenario"),
    (("executive", "soccer", "--goal", ""), "--goal is empty, expected a PDDL goal"),
    (("executive", "soccer", "--goal", "(", "--wait"), "--goal: expected without --wait"),
    (("goal", " "), "the goal is empty, expected a PDDL goal"),
]
FIRST = {arguments[0]: arguments for arguments, _ in reversed(MISTAKES)}  # by command


@pytest.mark.parametrize(("arguments", "expected"), MISTAKES)
def test_an_error_on_the_command_line_is_reported_in_one_line(arguments, expected, monkeypatch, capsys):
    """The first one of each command by a process of its own."""
    monkeypatch.chdir(ROOT)
    is_first = arguments == FIRST[arguments[0]]
    if arguments[0] in ("goal",):
        arguments = (*arguments, "--connect", free_endpoint())
    assert expected in (refused(*arguments) if is_first else refused_here(capsys, *arguments))


def test_a_demonstration_of_an_unknown_scenario_removes_no_recording(tmp_path):
    recording = tmp_path / "greedy.mcap"
    recording.write_bytes(b"precious")
    assert "no scenario 'nope'" in refused("demo", "--scenario", "nope", "--output", tmp_path)
    assert recording.read_bytes() == b"precious"


def test_a_folder_is_no_output(tmp_path, capsys):
    folder = tmp_path / "p.png"
    folder.mkdir()
    assert refused_here(capsys, "picture", "a.mcap", "-o", folder).endswith("p.png: is a folder, expected a file")


@pytest.mark.parametrize("command", [("up", "soccer", "--once"), ("bus",)])
def test_a_bus_for_other_machines_without_keys_is_refused_before_anything_starts(tmp_path, command):
    """A robot would drive, and nobody on another machine could stop it."""
    line = refused(*command, "--secure", "--keys", tmp_path / "none", "--connect", free_endpoint())
    assert "none/router: no authority.pem, expected a folder that `tailor keys new router --host ADDRESS` made" in line


@pytest.mark.promise("P39")
def test_unknown_key_in_a_deployment_file(tmp_path, capsys):
    file = tmp_path / "d.toml"
    file.write_text("[executive]\nsed = 1\n[bus]\nendpoint = 5\n")
    line = refused_here(capsys, "up", "soccer", "--config", file)
    assert "unknown key 'executive.sed'" in line
    assert "'bus.endpoint' is 5" in line


@pytest.mark.promise("P39")
def test_planner_of_a_deployment_file_is_checked_before_anything_starts(tmp_path, capsys):
    file = tmp_path / "d.toml"
    file.write_text('[planner]\ncommand = "no-such-vhpop"\nlimit_s = 2\n')
    assert "there is no program 'no-such-vhpop'" in refused_here(capsys, "up", "soccer", "--config", file)
    file.write_text('[planner]\ncommand = "true"\nlimit_s = 0\n')
    assert "planner.limit_s is 0, expected seconds above 0" in refused_here(capsys, "up", "soccer", "--config", file)


def test_port_in_use(capsys):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        endpoint = f"tcp/127.0.0.1:{taken.getsockname()[1]}"
        assert "the port is in use" in refused_here(capsys, "up", "soccer", "--connect", endpoint)


def test_a_recording_that_exists_is_refused_before_anything_starts(tmp_path, capsys):
    (tmp_path / "run.mcap").write_text("precious")
    assert "run.mcap: exists already" in refused_here(capsys, "up", "soccer", "--record", tmp_path / "run.mcap")


@pytest.mark.parametrize("place", ["file/run.mcap", "/proc/run.mcap"])
def test_a_recording_that_cannot_be_written_is_refused_before_anything_starts(tmp_path, place, capsys):
    (tmp_path / "file").write_text("no folder")
    flags = ("--record", tmp_path / place, "--connect", free_endpoint())
    assert str((tmp_path / place).parent) in refused_here(capsys, "up", "soccer", *flags)


@pytest.fixture
def zoo(tmp_path):
    return shutil.copytree(ZOO, tmp_path / "zoo")


def test_missing_model_file(zoo, capsys):
    (zoo / "agilo/goToPose/duration.onnx").unlink()
    assert "goToPose/duration" in refused_here(capsys, "up", "soccer", "--zoo", zoo)


def test_model_that_was_never_made(zoo, capsys):
    for file in (zoo / "agilo/approachBall").glob("success.*"):
        file.unlink()
    for command in ("executive", "up"):
        line = refused_here(capsys, command, "soccer", "--zoo", zoo)
        assert "action approachBall needs the model approachBall/success" in line


def test_altered_model_file(zoo, capsys):
    path = zoo / "agilo/dribbleBall/duration.onnx"
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)
    line = refused_here(capsys, "up", "soccer", "--zoo", zoo)
    assert "dribbleBall/duration" in line


GOLDEN = ROOT / "tests" / "data" / "golden" / "soccer-approach.mcap"


def test_an_output_that_cannot_be_written_is_reported_in_one_line():
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            tailor("info", str(GOLDEN)),
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            cwd=ROOT,
        )
    assert (done.returncode, done.stderr) == (1, "tailor info: No space left on device\n")


@pytest.mark.parametrize(
    "arguments", [("info", "--json", str(GOLDEN)), ("--help",), ("up", "--help"), ("models", "list")]
)
def test_a_closed_pipe_is_not_reported_as_an_error(arguments):
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run(
        tailor(*arguments), stdout=writer, stderr=subprocess.PIPE, text=True, cwd=ROOT, timeout=PATIENCE_S
    )
    os.close(writer)
    assert done.stderr == ""
    assert done.returncode == (0 if "up" in arguments else 1)  # argparse ignores it
