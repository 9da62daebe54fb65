"""The `tailor` command: version, overview, help, unknown commands."""

import io
import re
import subprocess
from contextlib import redirect_stdout

import pytest

import tailor
from tailor.tools.main import COMMANDS, main

PERSONAL = re.compile(r"\b(said|told|asked|says|tells?|asks?)\b", re.IGNORECASE)


def test_version_is_that_of_the_package(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"tailor {tailor.__version__}\n"


@pytest.mark.parametrize("arguments", [[], ["--help"], ["-h"]])
def test_the_overview_lists_every_command(capsys, arguments):
    assert main(arguments) == 0
    listed = [line.split()[0] for line in capsys.readouterr().out.splitlines() if line.startswith("  ")]
    assert sorted(listed) == sorted(COMMANDS)


def test_an_unknown_command_is_reported_in_one_line(capsys):
    assert main(["fly"]) == 2
    captured = capsys.readouterr()
    assert (captured.out, captured.err.count("\n")) == ("", 1)
    assert captured.err == "tailor: unknown command 'fly' (see tailor --help)\n"


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        (["evaluat"], "evaluate"),
        (["up", "--sceanrio", "aligned"], "--scenario"),
        (["plan", "a", "b", "--jsn"], "--json"),
    ],
)
def test_what_was_probably_meant_is_asked_for(capsys, words, meant):
    assert main(words) == 2
    assert f", did you mean {meant}? (see tailor" in capsys.readouterr().err


def complete(line, folder):
    """Completions of the last word by bash."""
    (folder / "script").write_text(completion_script("bash"))
    words = " ".join(f'"{word}"' for word in line.split(" "))
    last = line.rsplit(" ", 1)[1]
    ask = (
        f"source ./script; COMP_WORDS=({words}); COMP_CWORD={line.count(' ')}; "
        f"_shtab_tailor tailor '{last}'; echo ${{COMPREPLY[@]}}"
    )
    return subprocess.run(["bash", "-c", ask], cwd=folder, text=True, capture_output=True, check=True).stdout.split()


def test_bash_completes_commands_and_flags(tmp_path):
    assert set(complete("tailor ev", tmp_path)) == {"evaluate"}
    assert "--scenario" in complete("tailor up --sc", tmp_path)


def completion_script(shell):
    with redirect_stdout(io.StringIO()) as printed:
        assert main(["completion", shell]) == 0
    return printed.getvalue()


def test_a_shell_without_completion_is_a_usage_error(capsys):
    assert main(["completion", "dos"]) == 2
    assert "invalid choice: 'dos'" in capsys.readouterr().err


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_a_help_text_in_technical_english(capsys, name):
    with pytest.raises(SystemExit) as ended:
        main([name, "--help"])
    text = capsys.readouterr().out
    assert ended.value.code == 0
    assert text.startswith(f"usage: tailor {name} ")
    assert PERSONAL.search(text) is None
