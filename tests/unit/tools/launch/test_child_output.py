"""What children print reaches the launcher's output at once, and takes bounded space in a system of weeks."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from tailor.tools.launch import child_output
from tailor.tools.launch.child_output import ChildOutput


def test_what_children_print_is_passed_on_line_by_line_while_they_run(tmp_path, monkeypatch):
    monkeypatch.setattr(child_output, "MAX_BYTES", 8)
    lines: list[str] = []
    with (tmp_path / "printed").open("w+") as file:
        output = ChildOutput(file, lines.append)
        assert not output.poll()
        for text in ("Traceback\nlast", " line\nno end"):  # as children do: through a copy of the same descriptor
            subprocess.run([sys.executable, "-c", f"print({text!r}, end='')"], stdout=file, check=True)
            while output.poll():
                pass
        assert lines == ["Traceback", "last line"]
        output.finish()
        output.finish()
    assert lines == ["Traceback", "last line", "no end"]


@pytest.fixture
def printing(tmp_path):
    """The output of children that print what is written to the file, and the lines passed on."""
    lines: list[str] = []
    with (tmp_path / "printed").open("w+") as file:
        yield file, ChildOutput(file, lines.append), lines


def printed(file, text):
    file.write(text)
    file.flush()


def test_what_was_passed_on_takes_no_space_and_children_write_on_where_they_were(printing, monkeypatch):
    monkeypatch.setattr(child_output, "FREE_BYTES", 65_536)
    file, output, lines = printing
    for k in range(100):
        printed(file, "x" * 65_535 + "\n")
        printed(file, f"{k}\n")
        while output.poll():
            pass
    assert lines[1::2] == [str(k) for k in range(100)]
    assert {len(line) for line in lines[::2]} == {65_535}
    assert os.fstat(file.fileno()).st_blocks * 512 < 10 * 65_536


def test_a_line_without_an_end_is_passed_on_in_parts(printing, monkeypatch):
    monkeypatch.setattr(child_output, "MAX_LINE", 8)
    file, output, lines = printing
    for text in ("12345678", "9", "ab"):
        printed(file, text)
        output.poll()
    assert lines == ["123456789"]
    output.finish()
    assert lines == ["123456789", "ab"]


def test_of_a_flood_the_newest_end_is_passed_on(printing, monkeypatch):
    monkeypatch.setattr(child_output, "MAX_WAITING", 6)
    file, output, lines = printing
    printed(file, "begin")
    output.poll()
    printed(file, "1234567890\nlast\n")
    output.finish()
    assert lines == ["begin", "[10 bytes that were printed too quickly are left out]", "", "last"]
