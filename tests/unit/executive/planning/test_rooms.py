"""The validator shares no code with the search; docs/planner.md lists the rooms as they are.

The order of all rooms: tests/unit/house/rooms.toml.
"""

import re
from collections import defaultdict

import pytest

from tailor.executive import planning
from tailor.executive.planning.structures.orderings import GOAL_STEP
from tests.unit.house.arrows import MODULES, ROOT, imported_modules

PLANNING = "executive/planning/"
FINISHED_PLANS = sorted(path for path in MODULES if path.startswith((f"{PLANNING}plans/", f"{PLANNING}semantics/")))


def reachable(path):
    """The planner's own modules that a module imports, directly or by way of others."""
    reached, pending = set(), [path]
    while pending:
        more = {other for other in imported_modules(pending.pop()) if other.startswith(PLANNING)} - reached
        reached |= more
        pending += more
    return reached


@pytest.mark.parametrize("path", FINISHED_PLANS)
def test_the_validator_and_its_room_share_nothing_with_the_search(path):
    rooms = {other.removeprefix(PLANNING).split("/")[0] for other in reachable(path)}
    assert rooms <= {"plans", "pddl", *(["semantics"] if "/semantics/" in path else [])}


def test_the_search_and_the_finished_plan_number_the_goal_alike():
    assert planning.GOAL == GOAL_STEP


def test_the_documentation_lists_every_file_in_its_room():
    inside = defaultdict(set)
    for path in MODULES:
        if path.startswith(PLANNING) and not path.endswith("__init__.py"):
            *room, name = path.removeprefix(PLANNING).removesuffix(".py").split("/")
            inside["/".join(room) or "root"].add(name)
    text = (ROOT / "docs" / "planner.md").read_text().partition("## How the code is laid out")[2].partition("\n## ")[0]
    rows = re.findall(r"^\| `?([\w/]+?)/?`?: [^|]*\| (.*) \|$", text, re.MULTILINE)
    assert {room: set(re.findall(r"`(\w+)`", files)) for room, files in rows} == inside
