"""The `tailor` command: version, overview, help, unknown commands."""

import re

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
    assert listed == list(COMMANDS)


def test_an_unknown_command_is_reported_in_one_line(capsys):
    assert main(["fly"]) == 2
    captured = capsys.readouterr()
    assert (captured.out, captured.err.count("\n")) == ("", 1)
    assert captured.err.startswith("tailor: unknown command 'fly' (expected one of: up, demo, ")


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_a_help_text_in_technical_english(capsys, name):
    with pytest.raises(SystemExit) as ended:
        main([name, "--help"])
    text = capsys.readouterr().out
    assert ended.value.code == 0
    assert text.startswith(f"usage: tailor {name} ")
    assert PERSONAL.search(text) is None
