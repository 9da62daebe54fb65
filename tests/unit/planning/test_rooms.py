"""The rooms of the planner form no circle, and the validator shares no code with the search."""

import ast
from pathlib import Path

import pytest

from tailor.executive import planning
from tailor.executive.planning.structures.orderings import GOAL_STEP

ROOT = Path(planning.__file__).parent
PREFIX = "tailor.executive.planning."
SEARCH = "root"
ALLOWED = {
    "pddl": set(),
    "structures": {"pddl"},
    "ground": {"pddl", "structures"},
    "flaws": {"pddl", "structures", "ground"},
    "ground_plans": {"pddl", "structures", "ground", "flaws", "plans"},
    "lifted": {"pddl", "structures", "ground", "flaws"},
    "plans": {"pddl"},
    SEARCH: {"pddl", "structures", "ground", "flaws", "ground_plans", "lifted", "plans"},
}
MODULES = sorted(path.relative_to(ROOT).with_suffix("").as_posix().replace("/", ".") for path in ROOT.rglob("*.py"))


def room(module):
    return module.split(".")[0] if "." in module else SEARCH


def imported(module):
    """The planner's own modules that a module imports anywhere, under TYPE_CHECKING and inside functions too."""
    names = set()
    for node in ast.walk(ast.parse((ROOT / f"{module.replace('.', '/')}.py").read_text())):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names |= {str(node.module), *(f"{node.module}.{alias.name}" for alias in node.names)}
    return {name.removeprefix(PREFIX) for name in names if name.startswith(PREFIX)} & set(MODULES)


def reachable(module):
    reached, pending = set(), [module]
    while pending:
        more = imported(pending.pop()) - reached
        reached |= more
        pending += more
    return reached


@pytest.mark.parametrize("module", MODULES)
def test_every_import_keeps_to_the_order_of_the_rooms(module):
    own = room(module)
    assert {room(other) for other in imported(module)} - {own} <= ALLOWED[own]


@pytest.mark.parametrize("module", MODULES)
def test_no_module_imports_itself_by_way_of_others(module):
    assert module not in reachable(module)


def test_ground_plans_read_of_finished_plans_only_the_result_type():
    used = {other for module in MODULES if room(module) == "ground_plans" for other in imported(module)}
    assert {other for other in used if room(other) == "plans"} == {"plans.plan"}


@pytest.mark.parametrize("module", [module for module in MODULES if room(module) == "plans"])
def test_the_validator_and_its_room_share_nothing_with_the_search(module):
    assert {room(other) for other in reachable(module)} <= {"plans", "pddl"}


def test_the_search_and_the_finished_plan_number_the_goal_alike():
    assert planning.GOAL == GOAL_STEP
