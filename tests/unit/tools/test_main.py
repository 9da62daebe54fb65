"""The `tailor` command: version, overview, help, unknown commands."""

import argparse
import importlib
import io
import re
import shlex
import subprocess
import sys
from contextlib import redirect_stdout

import pytest

import tailor
from tailor.tools.cli.extras import EXTRAS
from tailor.tools.command_parser import CommandParser
from tailor.tools.main import COMMANDS, main
from tests.support.bus_system import ROOT

PERSONAL = re.compile(r"\b(said|told|asked|says|tells?|asks?)\b", re.IGNORECASE)


def test_version_is_that_of_the_package(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"tailor {tailor.__version__}\n"


@pytest.mark.parametrize("arguments", [[], ["--help"], ["-h"]])
def test_the_overview_lists_every_command(capsys, arguments):
    assert main(arguments) == 0
    listed = [line.split()[0] for line in capsys.readouterr().out.splitlines() if line.startswith("  ")]
    assert sorted(listed) == sorted(COMMANDS)


SCHEDULING = "print(os.sched_getscheduler(0), os.sched_getparam(0).sched_priority, os.getpriority(os.PRIO_PROCESS, 0))"
REAL_TIME = "os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))"
NICE = "os.setpriority(os.PRIO_PROCESS, 0, -20)"
REFUSED = "def refuse(*_): raise PermissionError"


def scheduling_after(code, *arguments):
    """Policy, real-time priority and nice value of a new process after some code."""
    code = f"import os\n{REFUSED}\ntry:\n    {code}\nexcept (OSError, SystemExit): pass\n{SCHEDULING}"
    done = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, cwd=ROOT)
    return done.stdout.splitlines()[-1]


@pytest.mark.parametrize("name", ["estop", "arm"])
def test_what_stops_robots_gets_the_cpu_first_where_the_system_permits_it(name):
    """Not by a nice value, which counts in one terminal only; by that where a real-time priority is refused."""
    refused, call = "os.sched_setscheduler = refuse; ", "from tailor.tools.main import main; main()"
    nice = scheduling_after(NICE)
    real_time = scheduling_after(REAL_TIME)
    assert scheduling_after(refused + call, name, "--help") == nice
    assert scheduling_after(call, name, "--help") == (nice if real_time == scheduling_after("pass") else real_time)
    assert scheduling_after(call, "status", "--help") == scheduling_after("pass")


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


@pytest.mark.parametrize(
    ("words", "error"),
    [
        ("--once up soccer", "tailor: '--once' stands before the command, expected it behind: tailor COMMAND --once"),
        ("up --secure soccer", "domain; 'soccer' was taken as a value of --secure, expected it before --secure (see"),
        ("train --data a b agilo --json", "robot; 'agilo' was taken as a value of --data, expected it before --data ("),
        ("train --data agilo", "tailor train: the following arguments are required: robot (see tailor train --help)"),
        ("up --seed 3", "tailor up: the following arguments are required: domain (see tailor up --help)"),
        ("replay run.mcap --from 3", "tailor replay: unrecognized arguments: --from 3 (see tailor replay --help)"),
    ],
)
def test_a_word_in_the_wrong_place_is_named(capsys, words, error):
    """The domain was said to be missing though it stood there, and --remap to be like --from."""
    assert main(words.split()) == 2
    assert error in capsys.readouterr().err


@pytest.mark.parametrize("command", [["demo", "--output"], ["letters", "A", "--output"]])
def test_a_file_in_the_place_of_a_folder_is_named_with_what_was_expected(capsys, tmp_path, command):
    (tmp_path / "file").touch()
    assert main([*command, str(tmp_path / "file")]) == 2
    assert capsys.readouterr().err == f"tailor {command[0]}: {tmp_path / 'file'}: File exists, expected a folder\n"


@pytest.mark.parametrize("command", COMMANDS)
def test_help_says_what_each_word_does_of_which_one_has_to_be_chosen(command):
    parser = argparse.ArgumentParser()
    importlib.import_module(COMMANDS[command][0]).configure(parser)
    placed = [each for each in parser._actions if not each.option_strings and each.metavar is None]
    chosen = [each for each in placed if len(each.choices or ()) > 1]
    assert [word for each in chosen for word in each.choices if f"{word}: " not in each.help] == []


def parser_of(command: str) -> CommandParser:
    parser = CommandParser(prog=f"tailor {command}", allow_abbrev=False)
    importlib.import_module(COMMANDS[command][0]).configure(parser)
    return parser


@pytest.mark.parametrize("command", COMMANDS)
def test_every_example_in_a_help_can_be_parsed(command):
    lines = re.findall(r"^  (tailor .*?)(?:  +.*)?$", parser_of(command).epilog or "", re.MULTILINE)
    for line in (part for whole in lines for part in whole.partition(" > ")[0].split("&&")):
        _, name, *words = shlex.split(line)
        parser_of(name).parsed(words)


@pytest.mark.parametrize("command", ["up", "keys", "driver", "record", "replay", "gather", "train", "models", "new"])
def test_the_help_of_a_command_with_many_flags_ends_with_examples(command):
    assert parser_of(command).epilog.count(f"\n  tailor {command} ") >= 2


def test_names_may_follow_flags(capsys):
    assert main(["models", "list", "--zoo", str(ROOT / "models/zoo"), "powercube", "--json"]) == 0
    printed = capsys.readouterr().out
    assert ("powercube" in printed, "agilo" in printed) == (True, False)


def test_a_name_too_many_is_refused_after_flags_too(capsys):
    assert main(["plan", "a", "--json", "b", "c"]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert main(["goal", "(a)", "--json", "(b)"]) == 2
    assert "unrecognized arguments: (b)" in capsys.readouterr().err


@pytest.mark.parametrize(("command", "required"), [("gather", "robot"), ("train", "robot"), ("models", "verb")])
def test_names_that_may_be_left_out_are_not_required(capsys, command, required):
    assert main([command]) == 2
    assert f"required: {required} (see" in capsys.readouterr().err


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


LACKING = """
import sys
sys.modules.update(dict.fromkeys(sys.argv[1].split(",")))  # an entry None makes the import fail
from tailor.tools import main
%s
"""
ONE_BY_ONE = "sys.exit(main.main(sys.argv[2:]))"
ALL_HELP = "import tailor.tools.completion as c; c.whole_parser()"


def called_without(modules, code, *arguments):
    """A process in which modules cannot be imported."""
    command = [sys.executable, "-c", LACKING % code, ",".join(modules), *arguments]
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT)


def test_every_command_has_its_help_without_any_extra():
    everything = [module for modules in EXTRAS.values() for module in modules]
    assert called_without(everything, ALL_HELP).stderr == ""


GOLDEN = "tests/data/golden/soccer-approach.mcap"


@pytest.mark.parametrize(
    ("arguments", "extra"),
    [
        (("train", "agilo"), "learn"),
        (("sim", "agilo"), "sim"),
        (("bench", "ticks"), "sim"),
        (("picture", GOLDEN), "plots"),
        (("models", "plot", "agilo/goToPose"), "plots"),
        (("why", GOLDEN, "-o", "out/why.png"), "plots"),  # before it explains anything
        (("compare", GOLDEN, GOLDEN, "--plot", "out/plot.png"), "plots"),
    ],
)
def test_a_missing_extra_is_named_in_one_line(arguments, extra):
    done = called_without(EXTRAS[extra], ONE_BY_ONE, *arguments)
    assert done.stderr == f"tailor {arguments[0]}: needs the extra {extra}: pip install 'tailor[{extra}]'\n"
    assert (done.returncode, done.stdout) == (2, "")


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


def test_an_interrupt_while_modules_load_prints_no_traceback():
    code = (
        "import sys\n"
        "def interrupt(event, arguments):\n"
        "    if event == 'import' and arguments[0] == 'argparse':\n"
        "        raise KeyboardInterrupt\n"
        "from tailor.tools.entry import main\n"
        "sys.addaudithook(interrupt)\n"
        "sys.exit(main())\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (130, "")


def test_an_interrupt_in_the_midst_of_a_library_s_start_prints_no_traceback(monkeypatch, capsys):
    """Extensions in C report it as an error of their own, as onnxruntime does."""

    def interrupted(name: str) -> None:
        raise ImportError("initialization failed") from KeyboardInterrupt()

    monkeypatch.setattr(importlib, "import_module", interrupted)
    assert main(["train"]) == 130
    assert capsys.readouterr().err == ""


def test_a_closed_standard_error_changes_no_exit_code_and_nothing_that_is_printed(monkeypatch, capsys):
    """As of a service that closed it."""
    monkeypatch.setattr(sys, "stderr", None)
    assert main(["plan", "nowhere.pddl"]) == 2
    assert main(["plann"]) == 2
    assert capsys.readouterr().out == ""
