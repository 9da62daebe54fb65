"""Whatever the locale: files of users are read as UTF-8, and what the output cannot hold is printed as "?"."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from tailor.runtime.processes.child import tailor
from tests.support.bus_system import ROOT
from tests.support.patience import PATIENCE_S

ASCII = {"LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}  # without these Python itself prefers UTF-8
GOLDEN = ROOT / "tests" / "data" / "golden"


def run(environment: dict[str, str], *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        tailor(*arguments),
        capture_output=True,
        encoding="latin-1",
        timeout=PATIENCE_S,
        cwd=ROOT,
        env=os.environ | environment,
    )


APPROACHES = f"{GOLDEN}/soccer-approach.mcap", f"{GOLDEN}/soccer-approach-dribble.mcap"


@pytest.mark.parametrize(
    ("environment", "arguments", "code"),
    [
        ({"PYTHONIOENCODING": "latin-1"}, ("compare", *APPROACHES), 1),
        (ASCII, ("compare", *APPROACHES), 1),
        ({"PYTHONIOENCODING": "ascii"}, ("why", APPROACHES[1]), 0),
        ({"PYTHONIOENCODING": "ascii"}, ("models", "rules", "agilo/goToPose"), 0),
    ],
    ids=["compare latin-1", "compare ascii", "why", "rules"],
)
def test_a_character_that_cannot_be_printed_is_replaced(
    environment: dict[str, str], arguments: tuple[str, ...], code: int
) -> None:
    done = run(environment, *arguments)
    assert (done.returncode, done.stderr) == (code, "")
    assert "?" in done.stdout


def test_a_name_that_is_no_utf_8_is_printed_as_it_is(tmp_path: Path) -> None:
    """Where Python prints it: with the locale C."""
    folder = os.fsdecode(os.fsencode(tmp_path) + b"/\xe9")
    done = run({"LC_ALL": "C"}, "models", "plot", "agilo/approachBall/success", "--out", folder)
    assert (done.returncode, done.stderr) == (0, "")
    assert "/\xe9/" in done.stdout


@pytest.mark.parametrize("arguments", [("up", "soccer", "--config"), ("make-models", "agilo", "--recipe")])
def test_files_are_read_as_utf_8(tmp_path: Path, arguments: tuple[str, ...]) -> None:
    (tmp_path / "file.toml").write_text('episodes = 9\n"b\u00fcrste" = 1\n', "utf-8")
    done = run(ASCII, *arguments, str(tmp_path / "file.toml"))
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert "unknown key 'b\\xfcrste'" in line
