"""`tailor letters`: writes, tabulates, draws; and reports what it cannot write."""

import pytest

from tailor.schemas.messages import ExecStatus
from tailor.tools.commands.run import letters
from tailor.tools.main import main
from tailor.tools.writing.writing_track import writing_track


def test_a_letter_is_written_tabulated_and_drawn(tmp_path, capsys):
    assert main(["letters", "i", "--lockstep", "--greedy", "--output", str(tmp_path)]) == 0
    output = capsys.readouterr().out
    assert all(hand in output for hand in ("stopping", "greedy", "refined"))
    assert {path.name for path in tmp_path.iterdir()} == {"I-joints.png", "I-page.png"}


def test_a_run_that_reaches_no_waypoint_is_named_instead_of_drawn(tmp_path, capsys, monkeypatch):
    def nothing(text, modes, seed):
        failed = ExecStatus(1, 1, "READY", "", "word-I", "", "failed", "", 0, 0.0, 0.0)
        return [writing_track(mode.name, text, [failed]) for mode in modes]

    monkeypatch.setattr(letters, "_in_lockstep", nothing)
    assert main(["letters", "i", "--lockstep", "--output", str(tmp_path)]) == 1
    assert capsys.readouterr().err.splitlines() == [
        "stopping: no waypoint was reached: failed",
        "refined: no waypoint was reached: failed",
    ]
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("text", ["", "TAILOR!", "Ä", "ABCDEFGHIJKLM"])
def test_what_cannot_be_written_is_reported(text, tmp_path, capsys):
    assert main(["letters", text, "--lockstep", "--output", str(tmp_path)]) == 2
    assert "1 to 12 of the letters A to Z" in capsys.readouterr().err


def test_a_word_for_the_soccer_robot_is_refused(capsys):
    assert main(["up", "soccer", "--letters", "HI"]) == 2
    assert "no scenario 'word-HI' in soccer" in capsys.readouterr().err
