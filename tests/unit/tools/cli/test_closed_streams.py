"""Commands whose standard streams are closed, as a script or a service may start them, or take no more output."""

import os
import subprocess
import sys

import pytest

from tailor.tools.main import main
from tests.support.bus_system import ROOT
from tests.support.planning.planning_problems import DATA

BODY = """
import os, sys
from tailor.tools.main import main
code = main(["--version"])
with open("recording", "wb") as file:
    for number in (1, 2):
        os.write(number, b"of a library in C")
    file.write(b"message")
print("of Python", file=sys.stderr)
print(sys.stdin, file=open("stdin", "w"))
sys.exit(code)
"""


@pytest.mark.parametrize("closed", ["<&- >&- 2>&-", ">&- 2>&-", "2>&-", "<&- 2>&-"])
def test_nothing_is_printed_into_a_file_that_a_command_opens_nor_to_another_stream(tmp_path, closed):
    """`tailor record 2>&-` ended with an empty file."""
    command = ["sh", "-c", f'exec "$0" -P -c "$1" {closed}', sys.executable, BODY]
    done = subprocess.run(command, cwd=tmp_path, env=os.environ, capture_output=True, text=True)
    assert done.returncode == 0
    assert (tmp_path / "recording").read_text() == "message"
    assert "of Python" not in done.stdout
    assert done.stderr == ""
    assert ((tmp_path / "stdin").read_text() == "None\n") is ("<&-" in closed), "an absent one is no empty one"


RUN = str(ROOT / "tests" / "data" / "golden" / "soccer-approach.mcap")
PROBLEM = [str(DATA / "own" / name) for name in ("kitchen-domain.pddl", "kitchen-s1.pddl")]
PRINTERS = [
    ["completion", "bash"],
    ["compare", RUN, RUN],
    ["info", RUN],
    ["models", "list"],
    ["plan", *PROBLEM],
    ["plan", "--json", *PROBLEM],
    ["why", RUN],
]


@pytest.mark.parametrize("arguments", PRINTERS, ids=lambda each: " ".join(word for word in each if "/" not in word))
def test_a_command_that_only_prints_fails_where_standard_output_is_closed(arguments, monkeypatch, capsys):
    monkeypatch.setattr(sys, "stdout", None)
    assert main(arguments) == 1
    assert capsys.readouterr().err == f"tailor {arguments[0]}: standard output is closed, expected an open one\n"


def test_a_picture_that_a_command_draws_besides_needs_no_standard_output(tmp_path):
    run, picture = RUN.replace("approach", "approach-dribble"), tmp_path / "why.png"
    command = ["sh", "-c", 'exec "$0" -P -m tailor.tools.main why "$1" -o "$2" >&-', sys.executable, run, str(picture)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, f"{picture}\n")
    assert picture.stat().st_size > 1000


@pytest.mark.parametrize(
    ("output", "expected"),
    [(">&-", "standard output is closed, expected an open one"), (">/dev/full", "No space left on device")],
)
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_output_that_is_lost_is_reported_in_one_line_whether_python_buffers_it_or_not(output, expected, unbuffered):
    """The interpreter flushed a full disk's output again at its end: a traceback, and exit code 120."""
    command = ["sh", "-c", f'exec "$0" -P -m tailor.tools.main info "$1" {output}', sys.executable, RUN]
    environment = {**os.environ, "PYTHONUNBUFFERED": unbuffered}
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (1, f"tailor info: {expected}\n")
