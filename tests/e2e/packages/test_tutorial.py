"""The commands of the tutorial (docs/new-robot.md) run, one after another, in a fresh environment."""

import re
import subprocess

import pytest

from tests.support.bus_system import ROOT

PAGE = ROOT / "docs" / "new-robot.md"
COMMANDS = re.compile(r"```sh\n(.*?)```", re.DOTALL)
# for time's sake; so few starts may prove nothing, which is exit code 1
FEWER = {"--episodes 1000": "--episodes 120", "--episodes 40": "--episodes 3 || test $? = 1"}
INSTALL = "pip install -e '.[test]'"  # would download setuptools

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("systems")]


def script(page: str, pip: str) -> str:
    """All commands of the page as one shell script."""
    text = "\n".join(COMMANDS.findall(page))
    for written, run in {**FEWER, INSTALL: pip}.items():
        assert written in text, written
        text = text.replace(written, run)
    return f"set -ex\n{text}"


def test_every_command_of_the_tutorial_succeeds(environment, tmp_path):
    commands = script(PAGE.read_text(), environment.pip_command("--no-build-isolation", "--editable", "."))
    work = tmp_path / "empty"
    work.mkdir()
    variables = environment.variables(XDG_DATA_HOME=str(tmp_path / "share"))
    done = subprocess.run(["sh", "-c", commands], cwd=work, capture_output=True, text=True, env=variables, timeout=2400)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    assert (work / "courier" / "run.html").is_file()
