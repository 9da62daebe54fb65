"""Planners from Python packages run by name; one that is not installed is reported with its pip command."""

import math
import sys
from importlib.util import find_spec

import pytest

from tailor.executive.deliberation.context import PlannerCommand
from tailor.executive.planning import parse_domain, parse_problem, validate
from tailor.runtime.planners import named
from tailor.runtime.processes.planner_process import split_command
from tailor.schemas.errors import UsageError
from tailor.tools.cli.systems.deployment import Deployment, executive_config
from tailor.tools.main import main
from tailor.tools.plan_search.sources import external
from tests.support.planning.planning_problems import DATA, own

KITCHEN = [str(DATA / "own" / f"kitchen-{name}.pddl") for name in ("domain", "s2")]
DURATIVE = [str(DATA / "own" / f"kitchen-durative-{name}.pddl") for name in ("domain", "s2")]
NEEDED = {"kairos": "kairos", "up:pyperplan": "up_pyperplan", "up:tamer": "up_tamer"}


def plan_by(command, name):
    needed = NEEDED[command.partition(":")[0] if command.startswith("kairos") else command]
    if find_spec(needed) is None:
        pytest.skip(f"{needed} is not installed")
    domain, problem = own(name)
    folder = DATA / "own"
    texts = (folder / f"{name.rsplit('-', 1)[0]}-domain.pddl").read_text(), (folder / f"{name}.pddl").read_text()
    result = external(command, texts, domain, problem, 60.0)
    assert result.plan is not None, result.reason
    assert validate(result.plan, domain, problem) == ""
    return result.plan


@pytest.mark.parametrize("name", ["kitchen-s2", "kitchen-durative-s3"])
@pytest.mark.parametrize("command", ["kairos", "kairos:0.2"])
def test_kairos_plans_are_sound_and_linked(command, name):
    assert plan_by(command, name).links


@pytest.mark.parametrize("tick_s", [0.01, 0.25, 2.0])
def test_kairos_keeps_dependent_events_a_tick_apart(tick_s, capsys):
    pytest.importorskip("kairos")
    texts = (
        """(define (domain d) (:requirements :durative-actions) (:predicates (p) (q))
          (:durative-action first :parameters () :duration (= ?duration 1.4) :condition () :effect (at end (p)))
          (:durative-action second :parameters () :duration (= ?duration 2.3) :condition (at start (p))
            :effect (and (at start (not (p))) (at end (q)))))""",
        "(define (problem x) (:domain d) (:init) (:goal (q)))",
    )
    domain = parse_domain(texts[0])
    for limit_s in (math.inf, 0.05):
        command = named.kairos_command(limit_s, tick_s)
        plan = external(command, texts, domain, parse_problem(texts[1], domain), 60.0).plan
        assert [step.start for step in plan.steps] == [0, pytest.approx(1.4 + tick_s)]


@pytest.mark.parametrize(
    ("command", "name"),
    [("up:pyperplan", "kitchen-s2"), ("up:tamer", "kitchen-s2"), ("up:tamer", "kitchen-durative-s2")],
)
def test_engines_of_unified_planning_give_sound_and_linked_plans(command, name):
    assert plan_by(command, name).links


@pytest.mark.parametrize(
    ("command", "package"), [("kairos", "kairos-planner"), ("kairos:3", "kairos-planner"), ("up:x", "unified-planning")]
)
def test_a_missing_package_is_one_line_with_the_pip_command(command, package, monkeypatch, capsys):
    monkeypatch.setattr(named, "find_spec", lambda name: None)
    assert main(["plan", *KITCHEN, "--planner", command]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    extra = command.partition(":")[0]
    assert f"the package {package} is not installed, install it with: pip install 'tailor[{extra}]'" in line


@pytest.mark.parametrize(
    "command", ["kairos:", "kairos:soon", "kairos:-1", "kairos:inf", "kairos::", "kairos:1:0", "up:"]
)
def test_what_follows_the_colon_is_checked(command, monkeypatch):
    monkeypatch.setattr(named, "find_spec", lambda name: object())
    with pytest.raises(UsageError, match="expected"):
        split_command(command)


def test_a_tick_that_is_none_is_not_taken_for_the_seconds(monkeypatch):
    monkeypatch.setattr(named, "find_spec", lambda name: object())
    with pytest.raises(UsageError, match=r"expected kairos:SECONDS or kairos:SECONDS:TICK, above 0, e\.g\. kairos:5"):
        split_command("kairos:5:0")


def test_other_commands_are_programs():
    assert split_command("true --kairos") == ["true", "--kairos"]
    assert named.named_planner("kairos --no-anytime") is None


NO_PLANNERS = [
    ("nope", "no engine nope is installed"),
    ("sequential_plan_validator", "the engine sequential_plan_validator is no planner"),
]


@pytest.mark.parametrize(  # each engine and each option once: to ask unified-planning for an engine takes seconds
    ("option", "engine", "reason"), [("--planner", *NO_PLANNERS[0]), ("--compare", *NO_PLANNERS[1])]
)
def test_an_engine_that_is_no_planner_is_refused_in_one_line_before_anything_is_planned(option, engine, reason, capsys):
    pytest.importorskip("unified_planning")
    assert main(["plan", *KITCHEN, option, f"up:{engine}"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"tailor plan: planner 'up:{engine}': {reason}, expected ")


def test_an_executive_does_not_start_with_an_engine_that_is_no_planner():
    engine, reason = NO_PLANNERS[1]
    pytest.importorskip("unified_planning")
    with pytest.raises(UsageError, match=reason):
        executive_config("soccer", Deployment(planner=PlannerCommand(f"up:{engine}")))


def test_an_engine_that_cannot_plan_a_task_is_named_with_the_reason(capsys):
    pytest.importorskip("up_pyperplan")
    assert main(["plan", *DURATIVE, "--planner", "up:pyperplan"]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("kitchen-durative-s2: no plan found: ")
    assert "'the engine pyperplan does not plan with continuous time" in line


@pytest.mark.parametrize(("name", "reason"), [("q", "'unsolvable'"), ("é", "'domain.pddl:1:38: error: ")])
def test_what_kairos_states_instead_of_a_plan_is_quoted(name, reason, tmp_path, capsys):
    pytest.importorskip("kairos")
    domain, problem = tmp_path / "domain.pddl", tmp_path / "problem.pddl"
    action = f"(:action a :parameters () :precondition ({name}) :effect (p))"
    domain.write_text(f"(define (domain d) (:predicates (p) ({name})) {action})")
    problem.write_text("(define (problem x) (:domain d) (:init) (:goal (p)))")
    assert main(["plan", str(domain), str(problem), "--planner", "kairos"]) == 1
    assert f"the planner ended with code 1: {reason}" in capsys.readouterr().err


def test_pddl_that_unified_planning_does_not_read_is_a_reason_in_one_line(tmp_path, capsys):
    pytest.importorskip("unified_planning")
    from tailor.runtime.planners import unified_planner
    from tailor.tools.up_engine import register

    register()
    domain = tmp_path / "derived.pddl"
    domain.write_text("(define (domain d) (:predicates (p) (q)) (:derived (p) (q)))")
    assert unified_planner.main("tailor", str(domain), KITCHEN[1]) == 1
    assert capsys.readouterr().out.startswith("unified-planning does not read the problem: Expected ')'")


def test_a_package_that_cannot_be_imported_is_one_line_with_its_error(monkeypatch):
    monkeypatch.setattr(named, "find_spec", lambda name: object())
    script = "import sys; print('Traceback', file=sys.stderr); sys.exit('ImportError: of grpc')"
    monkeypatch.setattr(named, "_module", lambda *_: [sys.executable, "-c", script])
    with pytest.raises(UsageError, match="planner 'up:x': unified-planning does not start: ImportError: of grpc"):
        named.check_engine("up:x")


def test_a_package_that_hangs_while_it_is_imported_is_refused(monkeypatch):
    monkeypatch.setattr(named, "CHECK_S", 0.3)
    monkeypatch.setattr(named, "find_spec", lambda name: object())
    monkeypatch.setattr(named, "_module", lambda *_: [sys.executable, "-c", "import time; time.sleep(60)"])
    with pytest.raises(UsageError, match="not loaded within"):
        named.check_engine("up:x")


def test_auto_asks_kairos_for_a_long_durative_problem_and_falls_back_to_the_search(monkeypatch, capsys):
    if not named.kairos_installed():
        pytest.skip("kairos-planner is not installed")
    assert main(["plan", *DURATIVE, "-v"]) == 0
    assert "kairos" not in capsys.readouterr().err, "short: the head start is enough"
    monkeypatch.setattr("tailor.tools.plan_search.sources.DURATIVE_HEAD_START", 3)
    assert main(["plan", *DURATIVE, "-v"]) == 0
    assert "the plan is by kairos" in capsys.readouterr().err
    monkeypatch.setattr(named, "named_planner", lambda command: ["true"])
    monkeypatch.setattr("tailor.runtime.processes.planner_process.named_planner", lambda command: ["true"])
    assert main(["plan", *DURATIVE, "-v"]) == 0
    assert "kairos" not in capsys.readouterr().err, "it had no plan: the search has one"
