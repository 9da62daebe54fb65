"""`tailor plan --compare`: figures of several planners side by side."""

import json
import shlex
import subprocess
import sys
import time

import pytest

from tailor.tools.main import main
from tailor.tools.planning import comparison
from tests.support.planning.planning_problems import DATA, printed

OWN = DATA / "own"
KITCHEN = [str(OWN / "kitchen-domain.pddl"), str(OWN / "kitchen-s1.pddl")]
DURATIVE = [str(OWN / "kitchen-durative-domain.pddl"), str(OWN / "kitchen-durative-s3.pddl")]


def printing(text, before=""):
    """The command of a planner that does something and prints a text."""
    return shlex.join([sys.executable, "-c", f"{before}\nprint({text!r})"])


def compared(capsys, files, *commands, options=()):
    arguments = [word for command in commands for word in ("--compare", command)]
    code = main(["plan", *files, *arguments, *options, "--json"])
    return code, json.loads(capsys.readouterr().out)


def test_a_sound_plan_an_unsound_one_and_none_are_told_apart(capsys):
    sound = printed("kitchen-s1.ground.plain")
    shorter = "".join(line for line in sound.splitlines(keepends=True) if "1:(" not in line)
    commands = (printing(sound), printing(shorter), printing("no plan"))
    code, rows = compared(capsys, KITCHEN, *commands)
    assert code == 0
    assert [row["planner"] for row in rows] == ["tailor", *commands]
    assert [row["valid"] for row in rows] == [True, True, False, False]
    assert [row["steps"] for row in rows] == [4, 4, None, None]
    assert "unsound" in rows[2]["reason"]
    assert all(row["makespan"] is None and row["cost"] is None for row in rows)


def test_makespans_and_the_time_of_other_processes_are_measured(capsys):
    busy = "import time\nwhile time.process_time() < 0.4: pass"
    code, rows = compared(capsys, DURATIVE, printing(printed("kitchen-durative-s3.ground.plain"), busy))
    assert code == 0
    assert rows[0]["makespan"] == pytest.approx(28.04)
    assert rows[1]["makespan"] == pytest.approx(56, abs=0.1)
    assert 0.4 <= rows[1]["cpu_s"] < 2


def test_every_planner_has_the_limit_of_time(capsys):
    code, rows = compared(capsys, KITCHEN, printing("", "import time; time.sleep(60)"), options=("-T", "0.01"))
    assert code == 0
    assert "killed after 0.6 s" in rows[1]["reason"]
    assert rows[1]["wall_s"] < 5


def test_times_of_ours_include_its_start_as_those_of_others_do():
    begun = time.monotonic()
    command = [sys.executable, "-m", "tailor.tools.main", "plan", *KITCHEN, "--compare", printing(""), "--json"]
    rows = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
    whole = time.monotonic() - begun
    assert rows[0]["cpu_s"] <= rows[0]["wall_s"] + 0.02  # one thread; the system rounds the start down to 10 ms
    assert rows[0]["wall_s"] + rows[1]["wall_s"] <= whole + 0.02


def test_what_checking_the_others_takes_is_not_counted_as_ours(capsys, monkeypatch):
    busy = [sys.executable, "-c", "import time\nwhile time.process_time() < 1: pass"]
    alone = compared(capsys, KITCHEN, printing(""))[1][0]
    monkeypatch.setattr(comparison, "check_engine", lambda command: subprocess.run(busy, check=True))
    assert compared(capsys, KITCHEN, printing(""))[1][0]["cpu_s"] < alone["cpu_s"] + 0.5


def test_the_first_planner_is_the_one_of_the_options(capsys):
    _, rows = compared(
        capsys, KITCHEN, printing(""), options=("--planner", printing(printed("kitchen-s1.ground.plain")))
    )
    assert rows[0]["planner"] == printing(printed("kitchen-s1.ground.plain"))
    assert rows[0]["valid"]
    assert rows[0]["cpu_s"] < 0.5 * time.process_time()  # without the start of this process


@pytest.mark.parametrize(
    ("output", "reason"),
    [
        (";kitchen-s1\nno plan\n;Problem has no solution.", "the planner ended with code 0: 'no plan'"),
        ("x" * 9999, "the planner ended with code 0: '" + "x" * 57 + "...'"),
        ("none (of 2 tries)", "the planner ended with code 0: 'none (of 2 tries)'"),
        ("1:(grip", "the planner ended with code 0; plan text, line 1: "),
        ("", "the planner ended with code 0; plan text: expected steps"),
    ],
)
def test_what_a_planner_states_instead_of_a_plan_is_quoted(capsys, output, reason):
    _, rows = compared(capsys, KITCHEN, printing(output))
    assert rows[1]["reason"].startswith(reason)


@pytest.mark.parametrize("form", ["--svg", "--dot", "--links"])
def test_a_form_of_plans_is_refused_beside_a_comparison(capsys, form):
    assert main(["plan", *KITCHEN, "--compare", printing(""), form]) == 2
    assert f"leave out {form}" in capsys.readouterr().err


def test_costs_are_those_of_the_metric(capsys, tmp_path):
    text = """(define (domain d) (:predicates (p) (q)) (:functions (total-cost))
      (:action dear :parameters () :effect (and (q) (increase (total-cost) 9)))
      (:action cheap :parameters () :effect (and (p) (increase (total-cost) 2)))
      (:action go :parameters () :precondition (p) :effect (and (q) (increase (total-cost) 3))))
      (define (problem one) (:domain d) (:init) (:goal (q)) (:metric minimize (total-cost)))"""
    (tmp_path / "both.pddl").write_text(text)
    _, rows = compared(capsys, [str(tmp_path / "both.pddl")], printing("(dear)"), options=("--anytime",))
    assert [row["cost"] for row in rows] == [5, 9]


def test_a_plan_without_a_cost_is_unsound_and_large_costs_have_all_their_digits(capsys, tmp_path):
    text = """(define (domain d) (:predicates (q)) (:functions (total-cost) (f ?x))
      (:action act :parameters (?x) :effect (and (q) (increase (total-cost) (f ?x)))))
      (define (problem one) (:domain d) (:objects a b) (:init (= (f b) 1234567.25)) (:goal (q)))"""
    (tmp_path / "both.pddl").write_text(text)
    files = [str(tmp_path / "both.pddl")]
    _, rows = compared(capsys, files, printing("(act a)"), options=("--lifted",))
    assert [row["cost"] for row in rows] == [1234567.25, None]
    assert "(act a) has no cost" in rows[1]["reason"]
    assert main(["plan", *files, "--compare", printing("(act b)")]) == 0
    assert capsys.readouterr().out.count("1234567.25") == 2


def test_without_a_plan_of_ours_the_code_is_1_and_a_missing_program_is_one_line(capsys):
    code, rows = compared(capsys, KITCHEN, printing(printed("kitchen-s1.ground.plain")), options=("-l", "3"))
    assert code == 1
    assert [row["valid"] for row in rows] == [False, True]
    assert main(["plan", *KITCHEN, "--compare", "no-such-planner"]) == 2
    assert "there is no program 'no-such-planner'" in capsys.readouterr().err


def test_a_program_without_the_right_to_execute_is_not_said_to_be_missing(capsys, tmp_path):
    (tmp_path / "planner").write_text("#!/bin/sh\n")
    assert main(["plan", *KITCHEN, "--compare", str(tmp_path / "planner")]) == 2
    assert f"'{tmp_path / 'planner'}' is not executable" in capsys.readouterr().err


def test_the_table_names_planners_and_verdicts(capsys):
    assert main(["plan", *KITCHEN, "--compare", printing("no plan")]) == 0
    out = capsys.readouterr().out
    assert "tailor" in out
    assert "sound" in out
    assert "ended with code 0" in out


def test_what_a_planner_prints_reaches_no_terminal_unescaped(capsys):
    rude = printing("\x1b[2J rude")
    assert main(["plan", *KITCHEN, "--planner", rude]) == 1
    assert "code 0: '\\x1b[2J rude'" in capsys.readouterr().err
    assert main(["plan", *KITCHEN, "--compare", "sh -c 'printf \\\\033[2J; echo rude'"]) == 0
    table = capsys.readouterr().out
    assert "\x1b" not in table
    assert "\\x1b[2Jrude" in table
