"""One process at a time gathers into a folder; whoever comes second is refused in one line."""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tailor.models.episodes.whole_files import only_writer
from tailor.tools.commands.learn import gather, make_models
from tailor.tools.main import main

HOLDER = """
import sys, time
from pathlib import Path
from tailor.models.episodes.whole_files import only_writer
with only_writer(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(600)
"""


@contextmanager
def holding(folder: Path) -> Iterator[None]:
    """Another process holds a folder in the block, and is killed at its end."""
    with subprocess.Popen([sys.executable, "-c", HOLDER, str(folder)], stdout=subprocess.PIPE) as holder:
        try:
            assert holder.stdout is not None
            assert holder.stdout.readline() == b"held\n"
            yield
        finally:
            holder.kill()


@pytest.mark.parametrize(
    ("command", "held"),
    [
        (["gather", "agilo", "goToPose", "--episodes", "1", "--resume", "--out"], "."),
        (["gather", "agilo", "--from", "nowhere.mcap", "--out"], "."),
        (["make-models", "agilo", "--work"], "agilo"),
    ],
)
def test_the_second_is_refused_until_the_first_is_killed(
    tmp_path: Path, capsys, monkeypatch, command: list[str], held: str
) -> None:
    folder = tmp_path / held
    reached: list[str] = []

    def work(*_: object) -> int:
        reached.append(command[0])
        return 0

    monkeypatch.setattr(gather, "_random", work)
    monkeypatch.setattr(gather, "_from_runs", work)
    monkeypatch.setattr(make_models, "make", lambda *_: ())
    monkeypatch.setattr(make_models, "install", work)
    with holding(folder):
        assert main([*command, str(tmp_path)]) == 2
    assert not reached
    expected = f"tailor {command[0]}: {folder}: another process gathers into it, expected another folder, or its end\n"
    assert capsys.readouterr().err == expected
    assert main([*command, str(tmp_path)]) == 0
    assert reached == [command[0]]


def test_folders_that_were_made_for_nothing_are_removed(tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    with only_writer(tmp_path / "there" / "new" / "newer"):
        pass
    with only_writer(tmp_path / "there"):
        pass
    assert [path.name for path in tmp_path.rglob("*")] == ["there"]
