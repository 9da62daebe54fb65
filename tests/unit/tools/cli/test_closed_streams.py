"""Commands whose standard streams are closed, as a script or a service may start them."""

import os
import subprocess
import sys

import pytest

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
