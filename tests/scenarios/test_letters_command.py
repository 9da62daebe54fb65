"""`tailor letters`: writes, tabulates, draws; and reports what it cannot write."""

import pytest

from tailor.tools.main import main


def test_a_letter_is_written_tabulated_and_drawn(tmp_path, capsys):
    assert main(["letters", "i", "--lockstep", "--greedy", "--output", str(tmp_path)]) == 0
    output = capsys.readouterr().out
    assert all(hand in output for hand in ("stopping", "greedy", "refined"))
    assert {path.name for path in tmp_path.iterdir()} == {"I-joints.png", "I-page.png"}


@pytest.mark.parametrize("text", ["", "TAILOR!", "Ä", "ABCDEFGHIJKLM"])
def test_what_cannot_be_written_is_reported(text, tmp_path, capsys):
    assert main(["letters", text, "--lockstep", "--output", str(tmp_path)]) == 2
    assert "1 to 12 of the letters A to Z" in capsys.readouterr().err


def test_a_word_for_the_soccer_robot_is_refused(capsys):
    assert main(["up", "soccer", "--letters", "HI"]) == 2
    assert "no scenario 'word-HI' in soccer" in capsys.readouterr().err
