"""`tailor.planning`: the planner as a library, under the name that programs import."""

import subprocess
import sys

import pytest

import tailor.planning
from tailor.executive import planning
from tests.support.bus_system import ROOT

BUDGETS = {"Budget", "CheckBudget"}


def test_it_has_every_public_name_of_the_planner_and_the_budgets():
    assert {*tailor.planning.__all__} == {*planning.__all__} | BUDGETS
    assert dir(tailor.planning) == sorted(tailor.planning.__all__)
    for name in planning.__all__:
        assert getattr(tailor.planning, name) is getattr(planning, name)


def test_other_names_are_missing():
    with pytest.raises(AttributeError, match=r"module 'tailor.planning' has no attribute 'plan'"):
        tailor.planning.plan  # noqa: B018


def test_the_import_loads_nothing_of_the_planner():
    code = "import sys, tailor.planning; print(*(name for name in sys.modules if name.startswith('tailor.')))"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT).stdout
    assert set(loaded.split()) == {
        "tailor.planning",
        "tailor.executive",
        "tailor.executive.planning",
        "tailor.executive.interfaces",
        "tailor.executive.interfaces.budget",
    }


def test_a_type_checker_sees_the_names(tmp_path):
    program = tmp_path / "program.py"
    program.write_text(
        "from tailor.planning import CheckBudget, Plan, Search, parse_domain, parse_problem\n"
        "def plan(domain: str, problem: str) -> Plan | None:\n"
        "    task = parse_problem(problem, parse_domain(domain))\n"
        "    result = Search(task.domain, task).advance(CheckBudget(100))\n"
        "    return result.plan if result is not None else None\n"
        "reveal_type(plan)\n"
    )
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache"), str(program)]
    printed = subprocess.run(command, capture_output=True, text=True, cwd=ROOT).stdout
    assert "def (domain: str, problem: str) -> tailor.executive.planning.plans.plan.Plan | None" in printed
